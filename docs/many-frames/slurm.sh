#!/usr/bin/env bash
#SBATCH --array=0-11
#SBATCH --cpus-per-task=2
#SBATCH --requeue
#SBATCH --open-mode=append
#
# A moving scene as a Slurm array: each task draws a range of frames.
#
#   sbatch --array=0-11 slurm.sh 4 tornado:20000 --shadows --out /shared/tornado-%04d.png
#
# draws frames 0 to 47, four a task. The first argument says how many a task draws, the others are those of
# `metaball animate`.
set -u
frames=$1
shift
first=$((SLURM_ARRAY_TASK_ID * frames))
export RAYON_NUM_THREADS=${SLURM_CPUS_PER_TASK:-1}

metaball animate "$@" --cpu --frames "$first..$((first + frames))"
code=$?

# Trouble of this machine, or a signal: Slurm may try again, here or elsewhere. What cannot be drawn anywhere
# ends with 2, and stays ended.
if ((code == 75 || code > 128)) && ((${SLURM_RESTART_COUNT:-0} < 3)); then
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
fi
exit "$code"
