#!/bin/sh
# SPDX-License-Identifier: MPL-2.0
# tools/format.sh [--check]: clang-format over all C++ files; with --check only says which would change.
set -eu
cd "$(dirname -- "$0")/.."
mode=-i
[ "${1-}" != --check ] || mode='--dry-run --Werror'
# shellcheck disable=SC2086  # mode is one or two words
git ls-files -z --cached --others --exclude-standard '*.hpp' '*.cpp' | xargs -0 "${CLANG_FORMAT:-clang-format}" $mode
