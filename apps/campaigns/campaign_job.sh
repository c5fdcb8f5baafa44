#!/bin/sh
# A campaign as a job of Slurm, over as many processors as it is given, on one machine or on many that share this folder:
#
#   sbatch --ntasks=64 apps/campaigns/campaign_job.sh apps/campaigns/random_contacts.yaml --runs 10000
#
# What follows the script goes to `flinch campaign`. FLINCH names the program where it is not on the PATH. The results are in
# out/NAME/results.part, from which a later call goes on. So a job that is ended or loses a node is queued again, and where
# one of its programs dies, mpirun ends the others and is called again, five times in all.
#SBATCH --job-name=flinch
#SBATCH --ntasks=4
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=flinch-%j.log

calls=1
again=${SLURM_RESTART_COUNT:-0}
while :; do
  if [ "$again" -gt 0 ]; then # what is done is kept, even by a call that was to begin anew
    for argument; do
      shift
      [ "$argument" = --fresh ] || set -- "$@" "$argument"
    done
  fi
  mpirun -n "$SLURM_NTASKS" "${FLINCH:-flinch}" campaign "$@"
  status=$?
  case $status in
    0 | 2 | 3) exit $status ;; # done, or what another call would say again
  esac
  [ $calls -lt 5 ] || exit $status
  calls=$((calls + 1))
  again=1
  echo "campaign_job.sh: a program was lost (status $status); call $calls of 5 does the runs that are left" >&2
done
