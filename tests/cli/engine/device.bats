#!/usr/bin/env bats
# --device and --precision: what is said where a device is not there, and LibTorch's engine on the CPU where it has been
# built.

load ../common

@test "a device of no name is a usage error, and so is a precision that the CPU does not have" {
    fails 64 synpo-eval --device gpu
    says "option --device: found 'gpu', expected cpu, torch-cpu, cuda or cuda:N"
    fails 64 synpo-train --device cuda:x </dev/null
    fails 64 synpo-finetune adapt --precision double -c x
    says "--precision: found 'double', expected float32, bf16 or tf32"
    synpo-gen-expert -q -n 1 >expert.jsonl
    fails 64 synpo-train --precision tf32 -n 1 <expert.jsonl
    says "found precision tf32 on the device cpu, expected float32 or bf16"
}

@test "products of bf16 on the CPU are asked for by --precision, and a policy acts as well with them" {
    synpo-gen-expert -q -n 4 >expert.jsonl
    if ! grep -qw avx512_bf16 /proc/cpuinfo; then
        fails 69 synpo-train --precision bf16 -n 1 -o out.ckpt <expert.jsonl
        why="found precision bf16 on the device cpu, whose processor has no products of it (AVX-512 BF16)"
        says "$why, expected float32"
        [ ! -e out.ckpt ]
        return
    fi
    small_training --precision bf16 -n 3 -j 1 --save save.ckpt --every 2 -o bf16.ckpt <expert.jsonl
    small_training --precision bf16 -n 3 -j 3 -o threads.ckpt <expert.jsonl
    SYNPO_KERNELS=bf16 small_training -n 3 -o kernels.ckpt <expert.jsonl
    cmp bf16.ckpt threads.ckpt
    cmp bf16.ckpt kernels.ckpt
    small_training -n 3 -o float.ckpt <expert.jsonl
    run ! cmp -s bf16.ckpt float.ckpt
    # Of the 400 episodes of a trained policy, rounding changes few ends.
    for precision in float32 bf16; do
        synpo-eval -q -n 1 --precision $precision "$BATS_TEST_DIRNAME/../../../examples/play/synpo.ckpt" >$precision.tsv
    done
    run ! cmp -s float32.tsv bf16.tsv
    paste <(cut -f 13 float32.tsv) <(cut -f 13 bf16.tsv) | awk 'NR > 1 { a += $1; b += $2 }
        END { print a, b; exit !(a > 360 && b > a - 12 && b < a + 12) }'
}

@test "without the plug-in a device is not available, and the message says how to get it" {
    export SYNPO_TORCH=$PWD/absent.so
    synpo-gen-expert -q -n 1 >expert.jsonl
    fails 69 synpo-train --device torch-cpu -n 1 -o out.ckpt <expert.jsonl
    says "no plug-in of LibTorch at $PWD/absent.so: make torch builds it"
    [ ! -e out.ckpt ]
}

@test "what is no plug-in is refused" {
    echo nothing >plugin.so
    export SYNPO_TORCH=$PWD/plugin.so
    synpo-gen-expert -q -n 1 >expert.jsonl
    fails 69 synpo-train --device torch-cpu -n 1 -o out.ckpt <expert.jsonl
    says "cannot load $PWD/plugin.so"
}

# A few updates with a small network.
small_training() { # OPTION...
    synpo-train -q --batch-states 24 --running 48 --fill 4 --basis 16 --embedding 16 --hidden 32 "$@"
}

@test "LibTorch trains, evaluates, adapts and tunes, and its checkpoints are the CPU's" {
    [ -e "$SYNPO_BUILD/libsynpo_torch.so" ] || skip "no plug-in: make torch"
    synpo-gen-expert -q -n 12 >expert.jsonl
    small_training --device torch-cpu -n 4 --save half.ckpt --every 2 -o torch.ckpt <expert.jsonl
    small_training -n 4 -o cpu.ckpt <expert.jsonl
    # The same bits again, and from the middle.
    synpo-train -q --device torch-cpu --resume half.ckpt -o again.ckpt <expert.jsonl
    cmp torch.ckpt again.ckpt
    # To and fro.
    synpo-train -q --resume half.ckpt -o other.ckpt <expert.jsonl
    for checkpoint in torch other; do
        for device in cpu torch-cpu; do
            synpo-eval -q -j 1 --device $device -p <(printf 'env\ttask\nmap1\tR-B\n') -n 2 -c $checkpoint.ckpt \
                >$checkpoint-$device.tsv
        done
    done
    # Their losses are the CPU's but for rounding: the first update's are of the same weights.
    for device in cpu torch-cpu; do
        small_training --device $device -n 1 --report 1 --log $device.tsv -o one.ckpt <expert.jsonl
    done
    paste <(tail -n 1 cpu.tsv) <(tail -n 1 torch-cpu.tsv) | awk -F '\t' '{ n = NF / 2
        for (i = 7; i <= 11; ++i)
            if ($i - $(i + n) > 1e-3 * $i || $(i + n) - $i > 1e-3 * $i) { print $i, $(i + n); bad = 1 }
        } END { exit bad }'
    synpo-gen-expert -q -n 3 >demos.jsonl
    synpo-finetune adapt -q --device torch-cpu -n 2 -c torch.ckpt <demos.jsonl >adapted.ckpt
    synpo-finetune ppo -q --device torch-cpu -j 1 --lanes 4 --rollout 4 --minibatches 2 --epochs 1 \
        --steps 16 -c torch.ckpt >tuned.ckpt
    synpo-eval --describe -c tuned.ckpt >/dev/null
}
