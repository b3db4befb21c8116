#!/usr/bin/env bash
# tests/scripts/steps_test.sh SOURCE_FOLDER: what scripts/lib/steps.sh shows, where its log goes, and what status it ends with.
set -uo pipefail
# shellcheck source=scripts/lib/steps.sh
. "$1/scripts/lib/steps.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

expect() { # WHAT EXPECTED FOUND
    if [ "$2" != "$3" ]; then
        printf '%s: expected\n%s\nfound\n%s\n' "$1" "$2" "$3"
        failures=$((failures + 1))
    fi
}

output_of() { # NAME: as that program prints
    case $1 in
        ninja) printf '[%d/5] Building CXX object\nsome warning: of a compiler\n' 1 2 3 4 5 ;;
        ctest) printf '  %d/20 Test  #7: name ...   Passed    0.01 sec\n' 1 10 20 ;;
        apt) printf '0 upgraded, 1 newly installed, 0 to remove\nGet:1 http://x\nUnpacking x\nSetting up x\n' ;;
        nearlight) printf '[10:00:00.000] debug: gathering: %d %%\n' 50 100 ;;
    esac
}

shown() { # NAME: the percentages
    run_logged "$folder/log/$1" "Step" output_of "$1" | sed -nE 's/^Step +([0-9]+) %.*/\1/p' | tr '\n' ' '
}

expect ninja "20 40 60 80 100 " "$(shown ninja)"
expect ctest "50 100 " "$(shown ctest)"
expect apt "33 66 100 " "$(shown apt)"
expect nearlight "50 100 " "$(shown nearlight)"
expect log "$(output_of ninja)" "$(cat "$folder/log/ninja")"
closing=$(run_logged "$folder/log/ninja" Step output_of ninja | tail -1)
expect "closing line" "Step  done in T; 5 warnings in $folder/log/ninja" "${closing/[0-9]:[0-9][0-9]/T}"
expect estimate " 50 %  [############............]  1:30 left" "$(progress_line 60 120 0 90)"
expect "estimate from a later start" " 75 %  [##################......]  0:10 left" "$(progress_line 75 100 50 10)"

# shellcheck disable=SC2317 # Called by run_step.
fails() {
    seq 100
    return 3
}
found=$(run_step "$folder/failed" "Step" fails 2>&1)
expect status 3 $?
expect "end of the log" "$(seq 71 100; echo "Step failed (exit status 3); the whole output is in $folder/failed")" "$found"
expect "whole log" "$(seq 100)" "$(cat "$folder/failed")"

# Ctrl-C reaches all processes of the foreground group.
cat >"$folder/interrupted.sh" <<'END'
set -euo pipefail
. "$1/scripts/lib/steps.sh"
run_step "$2/interrupted" "Step" bash -c 'trap "echo stopped; exit 1" INT; echo started; for ((i = 0; i < 300; ++i)); do sleep 0.1; done'
END
set -m # With job control a command in the background has a process group of its own, and heeds interrupts.
bash "$folder/interrupted.sh" "$1" "$folder" 2>/dev/null &
set +m
until grep -q started "$folder/interrupted" 2>/dev/null; do
    sleep 0.05
done
kill -INT -- "-$!"
wait "$!"
expect "status after an interrupt" 130 $?
expect "log after an interrupt" $'started\nstopped' "$(cat "$folder/interrupted")"
exit $((failures > 0))
