#!/bin/sh
# Prints commands that draw a moving scene together, one a line: each draws a range of frames, again where the
# machine was in trouble.
#
#   sh commands.sh 0 48 4 tornado:20000 --shadows --out /shared/tornado-%04d.png | xargs -d '\n' -P 2 -n 1 sh -c
#   sh commands.sh 0 48 4 tornado:20000 --shadows --out /shared/tornado-%04d.png | parallel -j 2
#
# draw frames 0 to 47, four a command and two commands at a time. The first frame, the one behind the last and how
# many a command draws come first, the others are arguments of `metaball animate`.
set -eu
first=$1 end=$2 frames=$3
shift 3
retry=$(cd "$(dirname "$0")" && pwd)/retry.sh

# Words as a shell reads them back.
quoted() {
    for word in "$@"; do
        printf " '%s'" "$(printf %s "$word" | sed "s/'/'\\\\''/g")"
    done
}

while [ "$first" -lt "$end" ]; do
    next=$((first + frames))
    [ "$next" -le "$end" ] || next=$end
    printf '%s\n' "sh$(quoted "$retry") metaball animate$(quoted "$@") --cpu --frames $first..$next"
    first=$next
done
