# The two commands of the README in a fresh Debian 12:
#   docker build -t rcme .
#   docker run --rm -v "$PWD/out:/rcme/build/demo" rcme      # scripts/demo; its table and plot are in out/
#   docker run --rm rcme scripts/test
#   docker run --rm -v "$PWD:/data" -w /data rcme rcme run study.yaml --out run.sqlite
FROM debian:12
ENV DEBIAN_FRONTEND=noninteractive LANG=C.UTF-8 PATH=/rcme/build/release/bin:$PATH
WORKDIR /rcme
COPY scripts/install-deps scripts/packages.txt scripts/show-progress scripts/
RUN apt-get update && apt-get install -y --no-install-recommends ca-certificates git && scripts/install-deps
COPY . .
RUN scripts/build release program
CMD ["scripts/demo"]
