# An image for CI: the program and the module, with the driver that draws frames pinned, on Debian 12.
#   scripts/package && docker build -t echelon . && docker run --rm -v "$PWD:/work" echelon capture seven-v -o frames
FROM debian:12.11-slim
# Frames are those of one driver: Debian 12 has Mesa 22.3.6 throughout.
ARG MESA=22.3.6-1+deb12u1
# hadolint ignore=DL3008 # Python is whatever Debian 12 has.
RUN apt-get update \
    && apt-get install -y --no-install-recommends "mesa-vulkan-drivers=${MESA}" python3 python3-venv \
    && rm -rf /var/lib/apt/lists/* \
    && python3 -m venv /opt/echelon
COPY dist/*.whl /tmp/
RUN /opt/echelon/bin/pip install --no-cache-dir --disable-pip-version-check /tmp/echelon-*.whl && rm /tmp/*.whl
ENV PATH="/opt/echelon/bin:${PATH}"
# Fails here, not in somebody's job, where the driver is missing.
RUN echelon capture line-three --at 0 --size 64x36 --adapter vulkan:llvmpipe -q -o /tmp/frames && rm -r /tmp/frames
WORKDIR /work
ENTRYPOINT ["echelon"]
CMD ["--help"]
