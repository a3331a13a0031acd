# To write controllers: the library for C++ with compiler and CMake, numpy.
#   docker build -f docker/dev.Dockerfile -t ziggurat-dev .
ARG CONTROLLER=ziggurat-controller
FROM ${CONTROLLER}
USER root
COPY build/package/packages/libziggurat0_*.deb build/package/packages/libziggurat-dev_*.deb /tmp/
RUN apt-get update \
 && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
      /tmp/*.deb g++ make cmake python3-numpy lua5.3 \
 && rm -rf /var/lib/apt/lists/* /var/cache/apt/* /var/log/* /tmp/*.deb \
 && mkdir -m 1777 /work
WORKDIR /work
USER 10001
ENTRYPOINT []
CMD ["bash"]
