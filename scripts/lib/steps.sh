# shellcheck shell=bash
# Functions for scripts, which source this file with `set -o pipefail`. They run a command with its output in a log,
# and show its progress on one line.

progress_title=
trap 'echo "$progress_title interrupted" >&2; exit 130' INT

minutes_and_seconds() { # SECONDS
    printf '%d:%02d' $(($1 / 60)) $(($1 % 60))
}

# progress_line COUNT TOTAL FIRST SECONDS: prints a line such as " 34 % [######..........] 1:20 left". The estimate of
# the time left assumes that all counted things take equally long; FIRST of them were done when SECONDS began. It is
# shown after 2 s.
progress_line() {
    local bar left=
    printf -v bar '%*s' $((24 * $1 / $2)) ''
    printf -v bar '%-24s' "${bar// /#}"
    if [ "$1" -gt "$3" ] && [ "$4" -ge 2 ]; then
        left="  $(minutes_and_seconds $(($4 * ($2 - $1) / ($1 - $3)))) left"
    fi
    printf '%3d %%  [%s]%s' $((100 * $1 / $2)) "${bar// /.}" "$left"
}

# count_line LINE: sets `count` and `total` of the caller if a line of output contains them.
count_line() {
    if [[ $1 =~ ^\[([0-9]+)/([0-9]+)\] || $1 =~ ^\ *([0-9]+)/([0-9]+)\ Test\ +# ]]; then # ninja, ctest
        count=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]}
    elif [[ $total -eq 0 || $total -eq 100 ]] && [[ $1 =~ :\ ([0-9]+)\ %$ ]]; then # nearlight --verbose
        count=${BASH_REMATCH[1]} total=100
    elif [[ $1 =~ ^([0-9]+)\ upgraded,\ ([0-9]+)\ newly\ installed ]]; then # apt-get
        count=0 total=$((3 * (BASH_REMATCH[1] + BASH_REMATCH[2])))
    elif [[ $total -gt 0 && $1 =~ ^(Get:|Unpacking\ |Setting\ up\ ) ]]; then # three for each package
        count=$((count < total ? count + 1 : total))
    fi
}

# show_progress TITLE <OUTPUT: shows on a terminal one line that is updated every second, elsewhere one line for every
# tenth. Nothing is drawn before the first count, so that sudo can ask for a password.
show_progress() {
    local title=$1 part line='' count=0 total=0 start='' first=0 tenth=0 shown
    trap '' INT # The output goes on until the command has stopped.
    while true; do
        if IFS= read -r -t 1 part; then
            count_line "$line$part"
            line=
        elif [ $? -gt 128 ]; then # A second is over, perhaps in the middle of a line.
            line+=$part
        else
            break
        fi
        [ "$total" -gt 0 ] || continue
        [ -n "$start" ] || start=$SECONDS first=$count
        shown="$title  $(progress_line "$count" "$total" "$first" $((SECONDS - start)))"
        if [ -t 1 ]; then
            printf '\r%s\033[K' "$shown"
        elif [ $((10 * count / total)) -gt "$tenth" ]; then
            tenth=$((10 * count / total))
            echo "$shown"
        fi
    done
    [ ! -t 1 ] || printf '\r\033[K'
}

# run_logged LOG TITLE COMMAND…: runs the command and returns its status.
run_logged() {
    local log=$1 start=$SECONDS status=0 warnings
    progress_title=$2
    shift 2
    mkdir -p "$(dirname "$log")"
    if [ -t 1 ]; then
        printf '%s ' "$progress_title"
    fi
    NINJA_STATUS='[%f/%t] ' "$@" 2>&1 | tee -i "$log" | show_progress "$progress_title" || status=${PIPESTATUS[0]}
    if [ "$status" -eq 0 ]; then
        warnings=$(grep -c 'warning: ' "$log") && warnings="; $warnings warnings in $log" || warnings=
        echo "$progress_title  done in $(minutes_and_seconds $((SECONDS - start)))$warnings"
    fi
    return "$status"
}

# run_step LOG TITLE COMMAND…: runs the command like run_logged; if it fails, shows the end of the log and exits with
# its status.
run_step() {
    local status=0
    run_logged "$@" || status=$?
    if [ "$status" -ne 0 ]; then
        tail -n 30 "$1" >&2
        echo "$2 failed (exit status $status); the whole output is in $1" >&2
        exit "$status"
    fi
}
