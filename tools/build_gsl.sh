#!/bin/sh
# SPDX-License-Identifier: MPL-2.0
# tools/build_gsl.sh PREFIX: downloads, builds and installs a static GSL, for wheels. Does nothing if it is there.
set -eu
prefix=${1:?"usage: tools/build_gsl.sh PREFIX"}
version=2.8
sum=6a99eeed15632c6354895b1dd542ed5a855c0f15d9ad1326c6fe2b2c9e423190
[ ! -e "$prefix/lib/libgsl.a" ] || exit 0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
curl -fsSL --retry 3 -o gsl.tar.gz "https://ftpmirror.gnu.org/gnu/gsl/gsl-$version.tar.gz"
sha256() { if command -v sha256sum >/dev/null; then sha256sum "$1"; else shasum -a 256 "$1"; fi; }
found=$(sha256 gsl.tar.gz | cut -d ' ' -f 1)
[ "$found" = "$sum" ] || { echo "build_gsl: gsl-$version.tar.gz has the SHA-256 $found, must be $sum" >&2; exit 1; }
tar -xzf gsl.tar.gz
cd "gsl-$version"
./configure --quiet --prefix="$prefix" --libdir="$prefix/lib" --disable-shared --with-pic CFLAGS=-O2
make -s -j "$(getconf _NPROCESSORS_ONLN)"
make -s install
