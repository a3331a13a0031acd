# The server, from Debian packages that packaging/debian/build has made. docker/build.sh builds all images.
#   docker build -f docker/server.Dockerfile -t ziggurat-server .
ARG BASE=debian:bookworm-slim
FROM ${BASE}
COPY build/package/packages/ziggurat_*.deb /tmp/
# Images have no documents.
RUN printf 'path-exclude %s\n' '/usr/share/doc/*' '/usr/share/man/*' '/usr/share/locale/*' >/etc/dpkg/dpkg.cfg.d/slim \
 && apt-get update \
 && DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends /tmp/*.deb \
 && rm -rf /var/lib/apt/lists/* /var/cache/apt/* /var/cache/debconf/*-old /var/log/* /tmp/*.deb \
 && useradd --uid 10001 --home-dir /nonexistent --shell /usr/sbin/nologin ziggurat
# The commands of documents have paths of the checkout.
WORKDIR /usr/share/ziggurat
USER 10001
EXPOSE 5770
# Sound while --metrics answers on its own address.
HEALTHCHECK --interval=10s --timeout=3s --start-period=5s \
  CMD ["bash", "-c", "exec 3<>/dev/tcp/127.0.0.1/9100 && printf 'GET /metrics HTTP/1.0\\r\\n\\r\\n' >&3 && read -r line <&3 && [[ $line == *' 200 '* ]]"]
ENTRYPOINT ["ziggurat"]
CMD ["help"]
