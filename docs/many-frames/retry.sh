#!/bin/sh
# Runs a command, and again while the machine is in trouble (75, or a signal), three times at most; ends as
# its last run does.
#
#   sh retry.sh metaball animate tornado:20000 --frames 0..4
#
# PAUSE says how many seconds lie between two runs.
for pause in "${PAUSE:-10}" "${PAUSE:-10}" "${PAUSE:-10}" none; do
    code=0
    "$@" || code=$?
    if [ "$code" -ne 75 ] && [ "$code" -le 128 ] || [ "$pause" = none ]; then
        exit "$code"
    fi
    sleep "$pause"
done
