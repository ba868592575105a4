# toposlam in a small image: docker build --tag toposlam . && docker run --rm toposlam check
# To read and write files, mount a folder: docker run --rm --volume "$PWD:/work" toposlam info run.mcap
# This file has not been built yet.
FROM rust:1-alpine AS build
RUN apk add --no-cache musl-dev
WORKDIR /source
COPY . .
RUN cargo build --profile dist --locked

FROM scratch
COPY --from=build /source/target/dist/toposlam /toposlam
COPY --from=build /source/worlds /worlds
COPY --from=build /source/LICENSE-APACHE /source/LICENSE-MIT /
WORKDIR /work
ENTRYPOINT ["/toposlam"]
CMD ["--help"]
