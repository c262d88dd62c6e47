# SPDX-License-Identifier: Apache-2.0
# The command for machines of a farm, from the sources beside this file:
#   docker build -t chromeball .
#   docker run --rm --user "$(id -u)" --volume "$PWD:/work" chromeball render scene.toml -o out.exr
# tools/scripts/test_package.sh tries these steps without a container engine.
FROM debian:bookworm-slim AS build
COPY . /chromeball
WORKDIR /chromeball
RUN tools/build.sh --packages-only && apt-get install -qy --no-install-recommends file
RUN tools/build.sh --target chromeball && cd build && cpack

FROM debian:bookworm-slim
COPY --from=build /chromeball/build/package /packages
RUN apt-get update -q && apt-get install -qy --no-install-recommends /packages/chromeball_*.deb && \
  rm -rf /packages /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["chromeball"]
