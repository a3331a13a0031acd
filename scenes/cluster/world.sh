#!/bin/sh
# One world on several nodes of Slurm: the server runs on the first node, controllers on the others.
#
#   sbatch --nodes=3 --ntasks-per-node=1 scenes/cluster/world.sh SCENE [OPTION-OF-SERVE...]
#
# Each other node runs CONTROLLER once (default: ziggurat-lua). It finds the server by ZIGGURAT_ENDPOINT, and
# is let in by keys that are made for this job; SLURM_PROCID tells it which of them it is. The
# scene's directors run beside the server. The world's hash at each tick, for example, is an option of serve:
# --hash-file FILE.
#
# Environment: CONTROLLER, PORT (default: 20000 to 29999, by the number of the job).
set -eu
umask 077
scene=$1
shift
# Keys and logs must be where all nodes see them.
folder=$(mktemp -d "$SLURM_SUBMIT_DIR/ziggurat-world-XXXXXX")
trap 'rm -rf "$folder"' EXIT
ziggurat keygen --out "$folder/server" >"$folder/log"
ziggurat keygen --out "$folder/controller" >>"$folder/log"
echo "$(cat "$folder/controller.public") controller controllers of this job" >"$folder/clients"

first=$(scontrol show hostnames "$SLURM_JOB_NODELIST" | head -n 1)
address=$(scontrol --oneliner show node "$first" | sed -n 's/.* NodeAddr=\([^ ]*\).*/\1/p')
port=${PORT:-$((20000 + SLURM_JOB_ID % 10000))}
others=$((SLURM_JOB_NUM_NODES - 1))

srun --nodes=1 --ntasks=1 --relative=0 --overlap ziggurat serve "$scene" --endpoint "tcp://0.0.0.0:$port" \
  --curve-secret "$folder/server.secret" --curve-clients "$folder/clients" "$@" &
server=$!
export ZIGGURAT_ENDPOINT="tcp://$address:$port"
ZIGGURAT_SERVER_KEY=$(cat "$folder/server.public")
export ZIGGURAT_SERVER_KEY ZIGGURAT_CURVE_SECRET="$folder/controller.secret"
if [ "$others" -gt 0 ]; then
  srun --nodes="$others" --ntasks="$others" --relative=1 --overlap ${CONTROLLER:-ziggurat-lua} &
else
  srun --nodes=1 --ntasks=1 --overlap ${CONTROLLER:-ziggurat-lua} &
fi
wait "$server"
