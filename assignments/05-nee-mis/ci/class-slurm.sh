#!/usr/bin/env bash
# Grades a class on a Slurm cluster: an array of shards, then a merge. Run it on a login node, in the checkout:
#
#   assignments/05-nee-mis/ci/class-slurm.sh SHARDS FOLDER [options of `grader class`]
#
# Checkout, FOLDER and --out must be on a file system that all nodes share. Build once before: cargo build --release -p grader
#
# One array task grades a shard, not a student: a grade takes some ten seconds of one core, and schedulers prefer few
# tasks that last. A task whose node is lost is queued again and continues where it was.
set -euo pipefail

if [ $# -lt 2 ]; then
  echo "usage: $0 SHARDS FOLDER [options of grader class]" >&2
  exit 2
fi
shards=$1
shift

# Resources of one task; another course may want others.
cpus=${CPUS_PER_TASK:-8}
memory=${MEM_PER_CPU:-2G}
limit=${TIME_LIMIT:-02:00:00}
grader=${GRADER:-$PWD/target/release/grader}
out=${OUT:-class-report}
mkdir -p "$out"

# The framework is built by the first task that needs it.
task=$(printf '%q ' "$grader" class "$@" --out="$out" --resume)
array=$(sbatch --parsable --requeue --array="1-$shards" --ntasks=1 --cpus-per-task="$cpus" --mem-per-cpu="$memory" \
  --time="$limit" --job-name=grade --output="$out/slurm-%a.log" --open-mode=append --wrap \
  "$task --jobs=\$SLURM_CPUS_PER_TASK --shard=\$SLURM_ARRAY_TASK_ID/$shards")

# `afterany`: a shard that ends with status 3 has graded the rest of its students. A shard that is missing or
# incomplete is refused by the merge itself, by name.
merge=$(printf '%q ' "$grader" merge --out="$out" ${MERGE_OPTIONS:-})
last=$(sbatch --parsable --dependency="afterany:$array" --ntasks=1 --cpus-per-task=1 --time=00:30:00 --job-name=merge \
  --output="$out/slurm-merge.log" --wrap "$merge")
echo "$last"
