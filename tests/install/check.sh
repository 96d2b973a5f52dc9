#!/usr/bin/env bash
# SPDX-License-Identifier: MPL-2.0
# Installs the headers into an empty folder, moves it, and builds and runs what users would write against it.
# check.sh --quick leaves out the static library revchain::compiled, which it takes from the build of ./run or ./test.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export CMAKE_GENERATOR=Ninja
checked=0

say() { printf -- '-- %s\n' "$*"; checked=$((checked + 1)); }
fail() { printf 'FAILED: %s\n' "$*"; exit 1; }
quietly() { "$@" >log 2>&1 || { cat log; fail "$*"; }; }

# build NAME SOURCE ARGS...: configures the consumer in SOURCE with the installed package, builds it, runs it.
build() {
  local name=$1 source=$2
  shift 2
  quietly cmake -S "$here/$source" -B "$name" -DCMAKE_PREFIX_PATH="$work/moved" "$@"
  quietly cmake --build "$name"
  "$name/consumer" || fail "the consumer $name gives wrong numbers"
}

# refuses TEXT ARGS...: find_package with ARGS as its arguments must fail and say TEXT.
refuses() {
  local text=$1
  shift
  mkdir -p refused
  printf 'cmake_minimum_required(VERSION 3.23)\nproject(refused CXX)\nfind_package(%s)\n' "$1" >refused/CMakeLists.txt
  shift
  rm -rf refused/build
  if cmake -S refused -B refused/build -DCMAKE_PREFIX_PATH="$work/moved" "$@" >log 2>&1; then fail "was found: $text"; fi
  tr -s '\n ' ' ' <log | grep -qF "$text" || { cat log; fail "does not say: $text"; }
}

quietly cmake -S "$root" -B library -DREVCHAIN_BUILD_TESTS=OFF -DREVCHAIN_BUILD_EXAMPLES=OFF -DREVCHAIN_ANALYTIC=ON
quietly cmake --install library --prefix "$work/installed"
mv installed moved

say 'find_package(revchain): two translation units, every warning an error, no GSL on the machine'
build core core -DCMAKE_DISABLE_FIND_PACKAGE_GSL=ON
if grep -qi gsl core/build.ninja; then fail 'GSL is on the command lines of a consumer of the core'; fi
if ninja -C core -t deps | grep -q '/gsl/'; then fail 'a header of GSL was read for the core'; fi
nm -C core/consumer >symbols
grep -q 'revchain::for_[a-z0-9_]*::Chain' symbols || fail 'the consumer of the core has no chain in it'
if grep -qE 'revchain::for_[a-z0-9_]*::(Rig|Flywheel|Displaced|Support|linear::Driven)' symbols; then
  fail 'a program of plain chains carries what chains can be rigged with'
fi
if grep -qE 'revchain::for_[a-z0-9_]*::.*([Aa]berth|[Ii]nterpolat|[Cc]ondens|models::)' symbols; then
  fail 'a program that includes modes.hpp alone carries methods that it did not ask for'
fi

say 'instruction sets chosen at run time, in a program compiled without optimisation'
printf '#include <revchain/simd/pack.hpp>\nvoid f(revchain::Pack<double, 8>& y, double x) { y = x * y; }\n' >packs.cpp
quietly "${CXX:-c++}" -std=c++20 -O0 -DREVCHAIN_DISPATCH -Imoved/include -S packs.cpp -o /dev/null

say 'steady shapes and branches without `thorough`'
build shapes core -DSOURCES=shapes.cpp -DCMAKE_DISABLE_FIND_PACKAGE_GSL=ON
shapes/consumer >brief
nm -C shapes/consumer >symbols
if grep -qE 'revchain::for_[a-z0-9_]*::.*(PostureSearch|WholeBalance|DiagramProver)' symbols; then
  fail 'a program that did not ask for thorough shapes carries their searches and proofs'
fi

say 'find_package(revchain COMPONENTS compiled)'
refuses "the component 'compiled' was not installed" 'revchain REQUIRED COMPONENTS compiled'
if [[ ${1-} != --quick ]]; then
  # The library that ./run and ./test have compiled for this machine.
  quietly cmake --build "$root/build/dev" --target revchain_compiled revchain_compiled_analytic
  quietly cmake --install library --prefix "$work/with_library"
  quietly cmake --install "$root/build/dev" --component compiled --prefix "$work/with_library"
  build compiled core -DCMAKE_PREFIX_PATH="$work/with_library" -DLIBRARY=compiled
  build compiled_shapes core -DSOURCES=shapes.cpp -DCMAKE_PREFIX_PATH="$work/with_library" -DLIBRARY=compiled
  compiled_shapes/consumer >thorough
  diff brief thorough || fail 'steady_shapes and branches give other numbers without `thorough`'
  build compiled_analytic analytic -DCMAKE_PREFIX_PATH="$work/with_library" -DLIBRARY=compiled_analytic

  say 'three builds of the library in one program, under the address sanitizer, linked in two orders'
  build mixed mixed -DCMAKE_PREFIX_PATH="$work/with_library"
  mixed/other_order || fail 'three builds of the library, linked in another order, give wrong numbers'
  for part in newer plain linked; do
    nm "mixed/CMakeFiles/$part.dir/answers.cpp.o" | sed -n 's/.* [VWu] \(.*8revchain.*\)/\1/p' | sort >"weak_$part"
    [[ -s weak_$part ]] || fail "no inline functions of the library in $part"
  done
  grep -q 8revchain8for_sse4 weak_newer || fail 'the name of a build does not tell its instruction set'
  if [[ -n $(cat weak_* | sort | uniq -d) ]]; then
    cat weak_* | sort | uniq -d | c++filt | head
    fail 'functions that were compiled differently have the same name'
  fi
  if cmake --build mixed --target misfit >log 2>&1; then fail 'code for another processor linked with the library'; fi
  grep -qE 'undefined reference to .*revchain::for_[a-z0-9_]*::modes<double>' log || { cat log; fail 'no name says why'; }
fi

say 'a plain checkout installs with Eigen alone, no Catch2 on the machine; BUILD_TESTING=OFF builds no tests'
quietly cmake -S "$root" -B plain -DCMAKE_DISABLE_FIND_PACKAGE_Catch2=ON -DCMAKE_DISABLE_FIND_PACKAGE_GSL=ON
quietly cmake --install plain --prefix "$work/plain_installed"
quietly cmake -S "$root" -B untested -DBUILD_TESTING=OFF
ctest --test-dir untested -N >log
grep -q '^Total Tests: 0$' log || { cat log; fail 'BUILD_TESTING=OFF leaves tests'; }

say 'find_package(revchain COMPONENTS analytic)'
build analytic analytic

if package=$("$root/.venv/bin/python" -m revchain --cmake-prefix 2>/dev/null); then
  say 'find_package in the installed Python package'
  build in_python light -DCMAKE_PREFIX_PATH="$package"
  grep -q "$package/include" in_python/build.ninja || fail 'the headers are not those of the Python package'
fi

say 'find_package that cannot succeed says why'
refuses "the component 'analytic' needs GSL" 'revchain REQUIRED COMPONENTS analytic' -DCMAKE_DISABLE_FIND_PACKAGE_GSL=ON
refuses "the component 'compiled_analytic' was not installed" 'revchain REQUIRED COMPONENTS compiled_analytic'
refuses "there is no component 'dynamics'" 'revchain REQUIRED COMPONENTS dynamics'
refuses 'compatible with requested version "99.1"' 'revchain 99.1 REQUIRED'

say 'add_subdirectory: none of our tests among theirs'
build subdirectory subdirectory -DREVCHAIN_SOURCE="$root"
ctest --test-dir subdirectory -N >log
grep -q '^Total Tests: 1$' log || { cat log; fail 'the consumer has one test of its own and no other'; }

say 'FetchContent'
build fetched subdirectory -DREVCHAIN_SOURCE="$root" -DFETCH=ON

say 'pkg-config'
export PKG_CONFIG_PATH=$work/moved/share/pkgconfig:${PKG_CONFIG_PATH-}
# shellcheck disable=SC2046  # flags are words
quietly "${CXX:-c++}" -std=c++20 "$here"/light/main.cpp $(pkg-config --cflags --libs revchain) -o with_pkg_config
./with_pkg_config
# shellcheck disable=SC2046
quietly "${CXX:-c++}" -std=c++20 "$here"/analytic/*.cpp $(pkg-config --cflags --libs revchain-analytic) -o with_pkg_config
./with_pkg_config

say 'C++17 is refused in one line'
# shellcheck disable=SC2046
if "${CXX:-c++}" -std=c++17 -fsyntax-only "$here/light/main.cpp" $(pkg-config --cflags-only-I revchain) 2>log; then
  fail 'compiled as C++17'
fi
grep -q 'error.*revchain needs C++20' log || { cat log; fail 'C++17: no message'; }
[[ $(grep -c 'error' log) -le 4 ]] || { cat log; fail 'C++17: more errors than one message'; }

say '-ffast-math and its parts are refused'
fast=(-ffast-math -ffinite-math-only)
"${CXX:-c++}" -dM -E -x c++ /dev/null | grep -q __clang__ ||  # Clang does not tell of these
  fast+=(-freciprocal-math '-fassociative-math -fno-signed-zeros -fno-trapping-math')
for flag in "${fast[@]}"; do
  # shellcheck disable=SC2046,SC2086
  if "${CXX:-c++}" -std=c++20 $flag -fsyntax-only "$here/light/main.cpp" $(pkg-config --cflags revchain) 2>log; then
    fail "compiled with $flag"
  fi
  grep -qiE '#error.*fast.?math' log || { cat log; fail "$flag is refused, but not by our #error"; }
done

echo "install: $checked kinds of consumers checked"
