# shellcheck shell=sh
# SPDX-License-Identifier: MPL-2.0
# Sourced by ./run, ./test, bench/run, paper/build and programs of tools/, with $root set: everything that has to be there before the work can start.
#   set_up EXTRAS NEED...   EXTRAS of the Python package (pyproject.toml), NEEDs from the table below

venv=${root:?}/.venv

# What a need is called by each package manager (brew has one python for all; a comma where it takes two packages).
#  need      apt                       brew      dnf                 conda
needs_table='
   compiler  g++                       gcc       gcc-c++             cxx-compiler
   cmake     cmake                     cmake     cmake               cmake
   ninja     ninja-build               ninja     ninja-build         ninja
   python    python3-venv,python3-dev  python    python3-devel       python
   eigen     libeigen3-dev             eigen     eigen3-devel        eigen
   gsl       libgsl-dev                gsl       gsl-devel           gsl
   catch2    catch2                    catch2    catch2-devel        catch2
   pkgconf   pkg-config                pkgconf   pkgconf-pkg-config  pkg-config
   ccache    ccache                    ccache    ccache              ccache
   lapack    libopenblas-dev           openblas  openblas-devel      openblas
   spectra   libspectra-dev            spectra   spectra-devel       spectralib
   boost     libboost-dev              boost     boost-devel         libboost-headers
   clang     clang                     llvm      clang               clangxx
   fuzzer    clang,libclang-rt-dev     llvm      clang,compiler-rt   clangxx,compiler-rt
   emscripten emscripten               emscripten emscripten         emscripten
   node      nodejs                    node      nodejs              nodejs
   chromium  chromium                  chromium  chromium            chromium
   pandoc    pandoc                    pandoc    pandoc              pandoc
   latex     texlive-latex-recommended,lmodern texlive texlive-collection-latexrecommended,texlive-lm texlive-core
'

# package_names COLUMN NEED...
package_names() {
  column=$1; shift
  for need; do
    printf '%s\n' "$needs_table" | awk -v need="$need" -v column="$column" '$1 == need { gsub(",", " ", $column); printf " %s", $column }'
  done
}

# install_line MANAGER NEED...
install_line() {
  manager=$1; shift
  case $manager in
    apt-get) echo "  sudo apt-get install$(package_names 2 "$@")" ;;
    brew) echo "  brew install$(package_names 3 "$@")" ;;
    dnf) echo "  sudo dnf install$(package_names 4 "$@")" ;;
    conda) echo "  conda install -c conda-forge$(package_names 5 "$@")" ;;
  esac
}

# Whether the compiler takes this C++20 text. It is asked, and no package manager: then a private prefix counts too.
compiles() {
  # shellcheck disable=SC2086  # flags are words
  printf '%b\n' "$1" | ${CXX:-c++} ${CPPFLAGS-} ${CXXFLAGS-} -x c++ -std=c++20 -fsyntax-only - 2>/dev/null
}

is_there() {
  case $1 in
    compiler) compiles '#include <concepts>' ;;
    cmake) command -v cmake ;;
    ninja) command -v ninja || command -v ninja-build ;;
    python) "${PYTHON:-python3}" -c 'import ensurepip, os, sys, sysconfig, venv
sys.exit(sys.version_info < (3, 11) or not os.path.exists(sysconfig.get_path("include") + "/Python.h"))' 2>/dev/null ;;
    eigen) compiles '#include <Eigen/Core>' || compiles '#include <eigen3/Eigen/Core>' ;;
    gsl) compiles '#include <gsl/gsl_sf_bessel.h>' ;;
    catch2) compiles '#if !__has_include(<catch2/catch.hpp>) && !__has_include(<catch2/catch_all.hpp>)\n#error\n#endif' ;;
    pkgconf) command -v pkg-config ;;
    ccache) command -v ccache ;;
    lapack) printf 'extern "C" void dsterf_(); int main() { dsterf_(); }' |
      ${CXX:-c++} -x c++ - -llapack -o /dev/null 2>/dev/null || [ -n "${OPENBLAS_HOME-}" ] ;;
    clang) command -v clang++ || command -v clang++-14 || command -v clang++-19 ;;
    fuzzer) printf 'extern "C" int LLVMFuzzerTestOneInput(const char*, unsigned long) { return 0; }' |
      clang++ -x c++ - -fsanitize=fuzzer,address,undefined -o /dev/null 2>/dev/null ;;
    emscripten) command -v emcc ;;
    node) command -v node ;;
    chromium) command -v chromium || command -v chromium-browser || command -v google-chrome ;;
    pandoc) command -v pandoc ;;
    latex) command -v pdflatex && kpsewhich lmodern.sty && kpsewhich booktabs.sty ;;
    boost) compiles '#include <boost/numeric/odeint.hpp>' ;;
    spectra) compiles '#if !__has_include(<Spectra/SymEigsSolver.h>)\n#error\n#endif' ;;
  esac >/dev/null
}

missing() {
  for need; do is_there "$need" || printf ' %s' "$need"; done
}

# install_needs NEED...: what is not there, by apt, and ccache with it where it can be had: builds use it, and work
# without. Elsewhere says what to install and ends with 3.
install_needs() {
  if command -v brew >/dev/null; then CPPFLAGS="${CPPFLAGS-} -I$(brew --prefix)/include"; fi
  lacking=$(missing "$@")
  [ -n "$lacking" ] || return 0
  sudo=
  [ "$(id -u)" = 0 ] || sudo=sudo
  # shellcheck disable=SC2086  # needs and packages are words
  if command -v apt-get >/dev/null && { [ -z "$sudo" ] || command -v sudo >/dev/null; }; then
    packages="$(package_names 2 $lacking) $(package_names 2 $(missing ccache))"
    echo "installing by apt:$packages"
    $sudo apt-get update -qq
    $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $packages >/dev/null
    lacking=$(missing "$@")
    [ -n "$lacking" ] || return 0
  fi
  echo "missing:$lacking. Install it and start again:" >&2
  here=
  for manager in apt-get brew dnf conda; do command -v $manager >/dev/null && here="$here $manager"; done
  # shellcheck disable=SC2086
  for manager in ${here:-apt-get brew dnf conda}; do install_line $manager $lacking >&2; done
  exit 3
}

# fresh STAMP PATH...: nothing under the paths is newer than the stamp. A file removed makes its folder newer.
fresh() {
  stamp=$1; shift
  [ -e "$stamp" ] && [ -z "$(find "$@" -newer "$stamp" -print -quit)" ]
}

pip() {
  "$venv/bin/python" -m pip --disable-pip-version-check --quiet "$@"
}

# What the package with EXTRAS needs, a requirement a line.
requirements() {
  "$venv/bin/python" -c 'import re, sys, tomllib
project = tomllib.load(open(sys.argv[1], "rb"))["project"]
def needed(extras):
    for extra in extras:
        for each in project["optional-dependencies"][extra]:
            own = re.fullmatch(r"revchain\[(.*)\]", each)
            yield from needed(own[1].split(",")) if own else [each]
print(*project["dependencies"], *needed(sys.argv[2].split(",")), sep="\n")' "$root/pyproject.toml" "$1"
}

# The package, showing ninja's count; all that was printed, where it fails. The module is compiled for this machine, in the
# folder of the preset dev: the tests link what it is made of.
build_package() {
  log=$root/build/python.log
  mkdir -p "$root/build"
  { "$venv/bin/python" -m pip --disable-pip-version-check --verbose install --no-build-isolation --no-deps \
    --config-settings=build-dir="$root/build/dev" --config-settings=build.targets=_core \
    --config-settings=cmake.define.REVCHAIN_PORTABLE=OFF --config-settings=cmake.define.REVCHAIN_BUILD_TESTS=AUTO \
    --config-settings=cmake.define.REVCHAIN_BUILD_COMPILED=OFF --config-settings=cmake.define.REVCHAIN_BUILD_BENCH=ON \
    --config-settings=cmake.define.REVCHAIN_BUILD_EXAMPLES=ON \
    "$root" 2>&1 && echo built || echo failed; } |
    tee "$log" | "$venv/bin/python" -c 'import re, sys
for line in sys.stdin:
    if step := re.match(r" *(\[\d+/\d+\].*)", line):
        print(step[1], flush=True)'
  [ "$(tail -n 1 "$log")" = built ] || { cat "$log" >&2; return 1; }
}

set_up() {
  extras=$1; shift
  stamp=$venv/revchain-$extras.stamp
  fresh "$stamp" "$root/CMakeLists.txt" "$root/pyproject.toml" "$root/tools/setup.sh" "$root/LICENSES" "$root/cmake" \
    "$root/include" "$root/bindings" "$root/src" && return 0

  install_needs "$@"
  use_ccache
  [ -x "$venv/bin/python" ] || "${PYTHON:-python3}" -m venv "$venv"
  touch "$stamp.new" # before the build: what is edited while it runs counts as newer
  echo "building the Python package in .venv: each step below is a file, and takes some seconds"
  # Without isolation, and in a folder that stays, so that the second build does only what has changed.
  # shellcheck disable=SC2046  # one requirement a line
  pip install $("$venv/bin/python" -c 'import sys, tomllib
print(*tomllib.load(open(sys.argv[1], "rb"))["build-system"]["requires"], sep="\n")' "$root/pyproject.toml")
  # The build asks every installed package for CMake files; one that cannot be imported would end it.
  "$venv/bin/python" -c 'import revchain' 2>/dev/null || pip uninstall -y revchain 2>/dev/null
  # Other packages meanwhile; Python compiles of them what is imported.
  requirements "$extras" >"$venv/requirements.txt"
  pip install --no-compile -r "$venv/requirements.txt" &
  others=$!
  build_package
  wait "$others"
  mv "$stamp.new" "$stamp"
}

jobs=$(getconf _NPROCESSORS_ONLN)
export CMAKE_BUILD_PARALLEL_LEVEL="$jobs" CTEST_PARALLEL_LEVEL="$jobs"
# Called after the needs are there; what was compiled in one checkout serves in another.
use_ccache() {
  command -v ccache >/dev/null || return 0
  export CMAKE_CXX_COMPILER_LAUNCHER=ccache CCACHE_BASEDIR="$root" CCACHE_NOHASHDIR=1
}
use_ccache
