#!/usr/bin/env bash
# Ensembles under MPI: one, two and four ranks give the same bits, with one thread and with two, also
# when ranks are killed and the run goes on from its checkpoint. Installs what it needs where Debian's
# packages are at hand.
set -euo pipefail
cd "$(dirname "$0")"

if ! command -v mpirun > /dev/null; then
    apt-get update -qq
    apt-get install -y -qq --no-install-recommends libopenmpi-dev openmpi-bin libclang-dev
fi
cargo build "$@" --example flips
profile=debug
[[ " $* " == *" --release "* ]] && profile=release
flips="$PWD/target/$profile/examples/flips"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mpi=(mpirun --allow-run-as-root --oversubscribe -n)
run() { local ranks=$1; shift; "${mpi[@]}" "$ranks" "$flips" "$@"; }

alone=$("$flips" --members 2000)
echo "$alone, alone"
for ranks in 1 2 4; do
    for threads in 1 2; do
        found=$(run "$ranks" --members 2000 --threads "$threads")
        [ "$found" = "$alone" ] || { echo "$ranks ranks, $threads threads: $found"; exit 1; }
    done
done

# Ranks die at random moments; OpenMPI then ends the whole run.
RANDOM=7
killed=0
for attempt in $(seq 1 "${KILLS:-50}"); do
    "${mpi[@]}" 3 "$flips" --members 2000 --checkpoint "$folder/run" > "$folder/out" 2> /dev/null &
    run=$!
    sleep "0.$(printf %02d $((35 + RANDOM % 40)))"
    ranks=($(pgrep -P "$run" || true))
    if [ ${#ranks[@]} -gt 0 ] && kill -9 "${ranks[RANDOM % ${#ranks[@]}]}" 2> /dev/null; then
        killed=$((killed + 1))
    fi
    wait "$run" || true
    # Every other shard is lost, so that the next run has work, and one is torn.
    files=("$folder"/run/shard-*.bin)
    [ -e "${files[0]}" ] || continue
    for file in "${files[@]}"; do
        [ $((RANDOM % 2)) = 0 ] || rm -f "$file"
    done
    torn=${files[RANDOM % ${#files[@]}]}
    [ ! -e "$torn" ] || truncate -s 20 "$torn"
done
found=$(run 2 --members 2000 --checkpoint "$folder/run")
[ "$found" = "$alone" ] || { echo "after ${KILLS:-50} kills: $found"; exit 1; }
[ "$killed" -ge $((${KILLS:-50} / 2)) ] || { echo "only $killed runs lost a rank"; exit 1; }
echo "the same bits for one, two and four ranks, and after $killed of ${KILLS:-50} runs lost a rank"
