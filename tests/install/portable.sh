#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# tests/install/portable.sh [JOBS]: builds the Python module as `pip install .` does elsewhere, which chooses among
# instruction sets at run time, into build/portable, runs the tests of the questions with it (./test --all), and builds
# C++ programs against the library that the package holds.
set -euo pipefail
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)
cd "$root"
site=build/portable/site python=${VIRTUAL_ENV:-.venv}/bin/python
"$python" -m pip install --quiet --no-deps --no-build-isolation --upgrade --target "$site" \
  -Cbuild-dir=build/portable/tree . 2>&1 | { grep -v 'WARNING: Target directory' || true; }
export PYTHONPATH=$root/$site
"$python" -c 'import revchain; assert "portable" in revchain.__file__, revchain.__file__'
tests=(tests/python/test_{modes,batch,accuracy,models,rig_modes,response,sensitivity,steady_shapes,rig_shapes,branches}.py
  tests/python/test_{cord_modes,held,light_links}.py)

# Folder of the consumer, component.
for consumer in core:compiled analytic:compiled_analytic; do
  cmake -S "tests/install/${consumer%:*}" -B "build/portable/${consumer#*:}" -G Ninja -DLIBRARY="${consumer#*:}" \
    -DCMAKE_PREFIX_PATH="$root/$site/revchain" >build/portable/consumer.log 2>&1 &&
    cmake --build "build/portable/${consumer#*:}" >>build/portable/consumer.log 2>&1 ||
    { cat build/portable/consumer.log; exit 1; }
  "build/portable/${consumer#*:}/consumer"
done
"$python" -m pytest -q -n "${1:-2}" -m 'not slow' "${tests[@]}"
