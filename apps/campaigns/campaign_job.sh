#!/bin/sh
# A campaign as a job of Slurm, over as many processors as it is given, on one machine or on many that share this folder:
#
#   sbatch --ntasks=64 apps/campaigns/campaign_job.sh apps/campaigns/random_contacts.yaml --runs 10000
#
# What follows the script goes to `flinch campaign`. FLINCH names the program where it is not on the PATH. A job that is
# ended or loses a node is queued again and goes on from where it was, for the results are in out/NAME/results.part.
#SBATCH --job-name=flinch
#SBATCH --ntasks=4
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=flinch-%j.log

exec mpirun -n "$SLURM_NTASKS" "${FLINCH:-flinch}" campaign "$@"
