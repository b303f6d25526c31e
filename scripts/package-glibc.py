"""Says which glibc the machine code in a wheel asks for: package-glibc.py MOST WHEEL. Exits with 1 if it is above MOST."""

import re
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path


def numbers(version: str) -> tuple[int, ...]:
    return tuple(int(part) for part in version.split("."))


def main() -> None:
    most, wheel = sys.argv[1], Path(sys.argv[2])
    too_new = False
    with tempfile.TemporaryDirectory() as folder, zipfile.ZipFile(wheel) as archive:
        archive.extractall(folder)
        files = [path for path in Path(folder).rglob("*") if path.is_file() and path.read_bytes()[:4] == b"\x7fELF"]
        for path in files:
            listed = subprocess.run(["readelf", "-V", "-d", path], check=True, capture_output=True, text=True).stdout
            asked = max(re.findall(r"GLIBC_([0-9.]+)", listed), key=numbers)
            needed = ", ".join(re.findall(r"\(NEEDED\).*\[(.*)\]", listed))
            size = path.stat().st_size / 1e6
            print(f"{path.relative_to(folder)}: {size:.1f} MB, glibc {asked}, {needed}")
            too_new |= numbers(asked) > numbers(most)
    if len(files) < 2:
        sys.exit(f"{wheel} lacks the module or the program")
    if too_new:
        sys.exit(f"a file of {wheel} asks for a newer glibc than {most}")
    told = subprocess.run(["auditwheel", "show", wheel], check=True, capture_output=True, text=True).stdout
    tag = re.search(r"manylinux_(\d+)_(\d+)_\w+", told)
    print(" ".join(told.split()))
    if tag is None or (int(tag[1]), int(tag[2])) > numbers(most):
        sys.exit(f"auditwheel finds {wheel} to be no manylinux_{most.replace('.', '_')}")


main()
