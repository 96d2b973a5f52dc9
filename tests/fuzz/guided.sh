#!/usr/bin/env bash
# SPDX-License-Identifier: MPL-2.0
# tests/fuzz/guided.sh SECONDS [FOLDER]: compiles the cases of tests/fuzz for libFuzzer (Clang) and runs them on inputs that
# libFuzzer chooses by the code they reach. It starts with the inputs in FOLDER and adds new ones there.
set -euo pipefail
[[ $# -eq 1 || $# -eq 2 ]] || { sed -n '3,4s/^# //p' "$0"; exit 2; }
cd "$(dirname -- "$0")/../.."
cmake --preset fuzzer
cmake --build --preset fuzzer
program=build/fuzzer/tests/fuzz failures=build/fuzzer/failures log=build/fuzzer/log.txt
mkdir -p $failures ${2+"$2"}
# A call throws after 60 s of processor time; -timeout ends a loop that does not look at the time.
if $program -seed=1 -max_len=512 -len_control=0 -timeout=300 -rss_limit_mb=2048 -malloc_limit_mb=1024 \
  -artifact_prefix=$failures/ -max_total_time="$1" -print_final_stats=1 ${2+"$2"} >$log 2>&1; then
  awk '/ cov: / {reached = $4} /number_of_executed_units/ {calls = $2} /slowest_unit/ {slowest = $2}
    END {print calls " inputs passed, the slowest took " slowest " s; " reached " places in the code reached"}' $log
else
  grep -vE '^#[0-9]+\s' $log | tail -n 80
  echo "guided random calls FAILED; repeat: $program $(sed -n 's/.*Test unit written to //p' $log)"
  exit 1
fi
