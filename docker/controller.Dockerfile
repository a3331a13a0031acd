# Controllers in Lua and Python: the server's image, and the Python package.
#   docker build -f docker/controller.Dockerfile -t ziggurat-controller .
ARG SERVER=ziggurat-server
FROM ${SERVER}
USER root
COPY build/package/packages/python3-ziggurat_*.deb /tmp/
RUN apt-get update \
 && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends /tmp/*.deb \
 && rm -rf /var/lib/apt/lists/* /var/cache/apt/* /var/log/* /tmp/*.deb
USER 10001
# A controller that has stopped is a container that has ended: nothing else is checked.
HEALTHCHECK NONE
ENTRYPOINT ["ziggurat-lua"]
CMD []
