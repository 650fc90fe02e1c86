# scripts/reproduce --slurm with a Slurm of its own: one node, this machine, with two processors, in a folder of the
# test. Needs what Debian has in slurm-wlm and munge.
load ../common

# Ports that nobody listens on; Slurm cannot be asked to choose.
free_port() {
    local port
    while port=$((20000 + RANDOM % 10000)); (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null; do :; done
    echo $port
}

start_slurm() {
    local user
    user=$(id -un)
    mkdir spool state
    (umask 077; head -c 128 /dev/urandom >munge.key)
    cat >slurm.conf <<END
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$(free_port)
SlurmdPort=$(free_port)
SlurmUser=$user
SlurmdUser=$user
AuthInfo=socket=$PWD/munge.socket,cred_expire=5
StateSaveLocation=$PWD/state
SlurmdSpoolDir=$PWD/spool
SlurmctldPidFile=$PWD/slurmctld.pid
SlurmdPidFile=$PWD/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,sched_min_interval=100000
JobCompType=jobcomp/filetxt
JobCompLoc=$PWD/finished
ReturnToService=2
KillWait=20
MailProg=/bin/true
NodeName=localhost NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes=localhost Default=YES State=UP
END
    export SLURM_CONF=$PWD/slurm.conf
    exec 8>daemons.log
    munged --foreground --force --socket="$PWD/munge.socket" --key-file="$PWD/munge.key" --pid-file="$PWD/munge.pid" \
        --log-file="$PWD/munge.log" --seed-file="$PWD/munge.seed" >&8 2>&8 3>&- &
    daemons=$!
    becomes yes is_socket munge.socket
    slurmctld -D >&8 2>&8 3>&- &
    daemons+=" $!"
    slurmd -D -N localhost >&8 2>&8 3>&- &
    daemons+=" $!"
    becomes idle sinfo -h -o %T
}

# becomes OUTPUT COMMAND...: waits until the command prints that.
becomes() {
    local i want=$1
    shift
    for ((i = 0; i < 1200; ++i)); do
        [ "$("$@" 2>/dev/null)" != "$want" ] || return 0
        sleep 0.05
    done
    complain "$*: found '$("$@" 2>&1)', expected '$want': $(tail -n 5 many/*.out daemons.log)"
}
is_socket() { [ ! -S "$1" ] || echo yes; }
there() { [ ! -s "$1" ] || echo yes; }

setup() {
    local program
    for program in munged munge slurmctld slurmd sbatch; do
        command -v $program >/dev/null || skip "no $program here"
    done
    set_up
    cp -r "$ROOT/scripts" .
    mkdir build
    for program in $TOOLS; do ln -s "$(command -v "$program")" build; done
    # A row in the log every other update, so that a training is known to have begun.
    rm build/synpo-train
    printf '#!/bin/sh\nexec %s "$@" --report 2\n' "$(command -v synpo-train)" >build/synpo-train
    chmod +x build/synpo-train
}

teardown() {
    [ -z "${job-}" ] || scancel -Q "$job" || true
    [ -z "${daemons-}" ] || kill $daemons || true
    wait
}

@test "reproduce --slurm: tasks requeued, out of time and cancelled go on, and the page is that of the serial way" {
    local asked=(small --budget 5120 -n 2) task
    scripts/reproduce "${asked[@]}" -o serial 2>serial.err
    start_slurm
    SBATCH_TIMELIMIT=30 scripts/reproduce "${asked[@]}" -o many --slurm -- --comment 'as asked'
    job=$(cat many/slurm.job)
    [ "$(squeue -h -r -j "$job" -o '%K %k %l' | sort)" = "$(printf '%s as asked 30:00\n' 1 2 3 4)" ]

    becomes yes there many/synpo-1.log
    scontrol requeue "${job}_1"
    becomes yes there many/mlp-1.log
    # What Slurm does before the time limit: SIGUSR1 to the script of the task.
    pkill -USR1 -f "^/bin/bash $PWD/spool/job0*$(squeue -h -r -j "${job}_2" -o %A)/slurm_script"
    squeue -r
    status=0
    scripts/reproduce "${asked[@]}" -o many --slurm 2>err || status=$?
    [ "$status" = 75 ]
    grep -q "^reproduce: job $job is not over" err
    becomes yes there many/mlp-2.log
    scancel "${job}_4"
    squeue -r

    becomes '' squeue -h -j "$job"
    tail -n 50 many/*.out finished
    for task in 1 2; do
        [ "$(grep -c ' goes on$' many/slurm-"${job}_$task".out)" = 1 ]
        [ "$(grep -c "JobState=PENDING.* ArrayTaskId=$task " finished)" = 1 ]
    done
    # What is cancelled stays so until it is asked for again.
    [ ! -f many/mlp-2.tsv ]
    [ -f many/mlp-2.save ]
    grep -q '^So far: 3 of 4 runs' many/README.md

    scripts/reproduce "${asked[@]}" -o many --slurm
    job=$(cat many/slurm.job)
    grep -qx '#SBATCH --array=4' many/slurm.sh
    becomes '' squeue -h -j "$job"
    grep -q 'mlp-2 goes on$' many/slurm-"${job}_4".out
    for file in README.md {synpo,mlp}-{1,2}.{tsv,ckpt}; do cmp serial/$file many/$file; done
    cat many/README.md
    scripts/reproduce "${asked[@]}" -o many --slurm
    [ "$(cat many/slurm.job)" = "$job" ]
}
