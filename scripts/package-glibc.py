"""Says which glibc the machine code in wheels and programs asks for: package-glibc.py MOST FILE... Exits with 1 if that is above
MOST, or if auditwheel finds that a wheel asks for more."""

import re
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path


def numbers(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in version.split("."))


def check(path: Path, most: str) -> None:
    """Ends the program if a file with machine code asks for a newer glibc."""
    listed = subprocess.run(["readelf", "-V", "-d", path], check=True, capture_output=True, text=True).stdout
    asked = max(re.findall(r"GLIBC_([0-9.]+)", listed), key=numbers)
    needed = ", ".join(re.findall(r"\(NEEDED\).*\[(.*)\]", listed))
    print(f"{path.name}: {path.stat().st_size / 1e6:.1f} MB, glibc {asked}, {needed}")
    if numbers(asked) > numbers(most):
        sys.exit(f"{path} asks for glibc {asked}, newer than {most}")


def check_wheel(wheel: Path, most: str) -> None:
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
        files = [path for path in Path(folder).rglob("*") if path.is_file() and path.read_bytes()[:4] == b"\x7fELF"]
        if not files:
            sys.exit(f"{wheel} has no machine code")
        for path in files:
            check(path, most)
    told = subprocess.run(["auditwheel", "show", wheel], check=True, capture_output=True, text=True).stdout
    print(" ".join(told.split()))
    tag = re.search(r"manylinux_(\d+)_(\d+)_\w+", told)
    if tag is None or (int(tag[1]), int(tag[2])) > numbers(most):
        sys.exit(f"auditwheel finds {wheel} to be no manylinux_{most.replace('.', '_')}")


def main() -> None:
    most, *files = sys.argv[1:]
    for path in map(Path, files):
        if path.suffix == ".whl":
            check_wheel(path, most)
        else:
            check(path, most)


main()
