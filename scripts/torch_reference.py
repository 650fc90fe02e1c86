#!/usr/bin/python3
"""The imitation-learning step of synpo in PyTorch: the reference of the C++ engine.

  torch_reference.py dump -o FILE [--batch N] [--seed S] [widths]
      one training step in float64 on a random model and batch, as safetensors
  torch_reference.py check FILE
      the same step in float32 from the file's parameters and inputs, against the file's results
  torch_reference.py bench --mode train|forward --batch N --threads T [--seconds S]
      states per second in float32 at full width, one number on stdout

The committed tests/data/torch_narrow.safetensors is `dump` with its defaults.
"""
import argparse
import copy
import ctypes
import itertools
import json
import math
import os
import statistics
import struct
import sys
import time

# A caller's OPENBLAS_CORETYPE or the like would slow PyTorch down unnoticed. Read when torch is loaded.
for key in [k for k in os.environ if k.startswith("OPENBLAS_")]:
    del os.environ[key]
if "--threads" in sys.argv[:-1]:  # PyTorch does not tell OpenBLAS how many threads to use
    os.environ["OPENBLAS_NUM_THREADS"] = sys.argv[sys.argv.index("--threads") + 1]

import numpy as np
import torch
from torch import nn
from torch.nn import functional as F
from torch.nn.utils.fusion import fuse_conv_bn_eval

ACTIONS = 5
STRIDES = (2, 2, 2, 1)
NARROW = dict(channels=(8, 16, 24, 32), feature=16, basis=12, embedding=10, hidden=24, envs=4, tasks=5)
FULL = dict(channels=(32, 64, 128, 256), feature=128, basis=128, embedding=128, hidden=512, envs=20, tasks=20)
REWARD_WEIGHT = 0.01
ADAM = dict(lr=0.001, betas=(0.9, 0.999), eps=1e-8, weight_decay=0.001)
ADAM_LIMIT = 2100  # larger tensors get no adam.NAME, which keeps the committed file small


# --- the model -----------------------------------------------------------------------------------

class Block(nn.Module):
    """conv norm relu conv norm, plus the shortcut, relu; a stage's first block changes the shape."""

    def __init__(self, inputs, outputs, stride, first):
        super().__init__()
        self.conv1 = nn.Conv2d(inputs, outputs, 3, stride, 1, bias=False)
        self.norm1 = nn.BatchNorm2d(outputs)
        self.relu1 = nn.ReLU(inplace=True)
        self.conv2 = nn.Conv2d(outputs, outputs, 3, 1, 1, bias=False)
        self.norm2 = nn.BatchNorm2d(outputs)
        self.relu2 = nn.ReLU(inplace=True)
        self.shortcut = nn.Conv2d(inputs, outputs, 1, stride, bias=False) if first else nn.Identity()
        self.shortcut_norm = nn.BatchNorm2d(outputs) if first else nn.Identity()

    def forward(self, x):
        y = self.relu1(self.norm1(self.conv1(x)))
        y = self.norm2(self.conv2(y))
        y += self.shortcut_norm(self.shortcut(x))
        return self.relu2(y)


class Encoder(nn.Module):
    """psi(s): [N, 12, 16, 16] -> [N, d]."""

    def __init__(self, channels, feature):
        super().__init__()
        inputs = 12
        for s, (outputs, stride) in enumerate(zip(channels, STRIDES), 1):
            blocks = [("block1", Block(inputs, outputs, stride, True)), ("block2", Block(outputs, outputs, 1, False))]
            self.add_module(f"stage{s}", nn.Sequential())
            for name, block in blocks:
                getattr(self, f"stage{s}").add_module(name, block)
            inputs = outputs
        self.fc = nn.Linear(4 * inputs, feature)

    def forward(self, x):
        x = self.stage4(self.stage3(self.stage2(self.stage1(x))))
        return self.fc(x.permute(0, 2, 3, 1).flatten(1))  # (y, x, channel)


class Mlp(nn.Module):
    def __init__(self, inputs, hidden, outputs):
        super().__init__()
        self.hidden = nn.Linear(inputs, hidden)
        self.relu = nn.ReLU(inplace=True)
        self.out = nn.Linear(hidden, outputs)

    def forward(self, x):
        return self.out(self.relu(self.hidden(x)))


class SynPo(nn.Module):
    def __init__(self, channels, feature, basis, embedding, hidden, envs, tasks):
        super().__init__()
        empty = lambda *shape: nn.Parameter(torch.zeros(*shape))
        self.encoder = Encoder(channels, feature)
        self.embedding = nn.ParameterDict({"env": empty(envs, embedding), "task": empty(tasks, embedding)})
        self.alpha = Mlp(2 * embedding, hidden, basis)
        self.beta = Mlp(2 * embedding, hidden, basis)
        self.theta = empty(ACTIONS, feature, basis)
        self.policy = nn.ParameterDict({"bias": empty(ACTIONS)})
        self.reward = nn.ParameterDict({"bias": empty(ACTIONS)})
        self.f_env = Mlp(basis, hidden, embedding)
        self.f_task = Mlp(basis, hidden, embedding)

    def pairs(self, env, task):
        """Distinct pairs as one embedding row each [P, 2*embedding], and each state's pair [N]."""
        tasks = len(self.embedding["task"])
        pairs, index = torch.unique(env * tasks + task, return_inverse=True)
        env, task = torch.div(pairs, tasks, rounding_mode="floor"), pairs % tasks
        return torch.cat([self.embedding["env"][env], self.embedding["task"][task]], 1), index

    def products(self, psi):
        """psi^T theta[a,:,k] for every action: [N, A, K]."""
        actions, feature, basis = self.theta.shape
        return (psi @ self.theta.permute(1, 0, 2).reshape(feature, actions * basis)).view(-1, actions, basis)

    # Three ways to the same logits; bench keeps the fastest. A head takes psi [N, d], the products or None,
    # coefficients [P, K], each state's pair [N], and returns psi^T (sum_k coefficient_k theta[a,:,k]) as [N, A].
    def by_sum(self, psi, products, coefficients, index):
        products = self.products(psi) if products is None else products
        return (products * coefficients[index].unsqueeze(1)).sum(2)

    def by_bmm(self, psi, products, coefficients, index):
        products = self.products(psi) if products is None else products
        return torch.bmm(products, coefficients[index].unsqueeze(2)).squeeze(2)

    def by_matrix(self, psi, products, coefficients, index):
        matrices = coefficients @ self.theta.flatten(0, 1).t()  # U of each pair: [P, A*d]
        return torch.bmm(matrices[index].view(-1, *self.theta.shape[:2]), psi.unsqueeze(2)).squeeze(2)

    HEADS = (by_sum, by_bmm, by_matrix)

    def logits(self, batch, head=by_sum):
        pairs, index = self.pairs(batch["env"], batch["task"])
        return head(self, self.encoder(batch["input"]), None, self.alpha(pairs), index) + self.policy["bias"]

    def losses(self, batch, weights, head=by_sum):
        """(total, policy, reward, env, task), logits, psi."""
        psi = self.encoder(batch["input"])
        products = self.products(psi)
        pairs, index = self.pairs(batch["env"], batch["task"])
        rows = torch.arange(len(psi))
        logits = head(self, psi, products, self.alpha(pairs), index) + self.policy["bias"]
        taken = batch["taken"]
        reward = (products[rows, taken] * self.beta(pairs)[index]).sum(1) + self.reward["bias"][taken]
        x = products[rows, batch["label"]]
        policy_loss = F.cross_entropy(logits, batch["label"])
        reward_loss = F.mse_loss(reward, batch["reward"])
        env_loss = F.cross_entropy(self.f_env(x) @ self.embedding["env"].t(), batch["env"])
        task_loss = F.cross_entropy(self.f_task(x) @ self.embedding["task"].t(), batch["task"])
        total = policy_loss + REWARD_WEIGHT * reward_loss + weights[0] * env_loss + weights[1] * task_loss
        return (total, policy_loss, reward_loss, env_loss, task_loss), logits, psi


def randomise(net, generator):
    """Random parameters under which activations are O(1) and nothing is zero that training would move."""
    normal = lambda p, sd, mean=0.0: p.copy_(mean + sd * torch.randn(p.shape, generator=generator))
    basis, embedding = net.theta.shape[2], net.embedding["env"].shape[1]
    with torch.no_grad():
        for name, p in net.named_parameters():
            if "norm" in name:
                normal(p, 0.2, 1.0 if name.endswith("weight") else 0.0)
            elif name.endswith("bias"):
                normal(p, 0.1)
            elif name.endswith("weight"):
                normal(p, math.sqrt((1 if "fc" in name else 2) / p[0].numel()))
            elif name == "theta":
                normal(p, 1 / math.sqrt(p.shape[1]))
            else:
                normal(p, 1)  # embeddings
        for head, width in ((net.alpha, basis), (net.beta, basis), (net.f_env, embedding), (net.f_task, embedding)):
            head.out.weight /= math.sqrt(width)  # its output goes into a sum over that many terms


# --- pictures ------------------------------------------------------------------------------------

FLOOR, WALL, AGENT = (50, 50, 50), (110, 80, 50), (255, 255, 255)
TREASURES = ((255, 0, 0), (0, 0, 255), (0, 255, 0), (255, 170, 0), (170, 0, 255))


def pictures(count, rng):
    """[N, 16, 16, 12] U8, channel = 3*frame + rgb: walks of an agent that sees 3 x 3 cells and treasures."""
    images = np.zeros((count, 16, 16, 4, 3), np.uint8)
    for image in images:
        wall = rng.random((16, 16)) < 0.3
        treasures = rng.integers(1, 15, (5, 2))
        y, x = rng.integers(1, 15, 2)
        for frame in range(rng.choice((0, 0, 0, 1, 2, 3)), 4):  # at an episode's start the earlier ones are black
            picture = image[:, :, frame]
            window = (slice(y - 1, y + 2), slice(x - 1, x + 2))
            picture[window] = np.where(wall[window][..., None], WALL, FLOOR)
            for (ty, tx), colour in zip(treasures, TREASURES):
                picture[ty, tx] = colour
            picture[y, x] = AGENT
            dy, dx = ((-1, 0), (1, 0), (0, -1), (0, 1))[rng.integers(4)]
            y, x = np.clip(y + dy, 1, 14), np.clip(x + dx, 1, 14)
    return images.reshape(count, 16, 16, 12)


def random_batch(count, envs, tasks, rng, pairs=None):
    """Arrays as they stand in the file; pairs: draw from that many distinct pairs only."""
    pair = rng.choice(rng.permutation(envs * tasks)[:pairs], count)
    label = rng.integers(0, ACTIONS, count)
    taken = np.where(rng.random(count) < 0.5, rng.integers(0, ACTIONS, count), label)
    if count > 1 and (taken == label).all():
        taken[0] = (label[0] + 1) % ACTIONS
    return dict(input=pictures(count, rng), env=pair // tasks, task=pair % tasks, label=label, taken=taken,
                reward=rng.choice((-0.01, -0.02, 0.99, 10.99, -10.01), count).astype(np.float32))


def to_torch(batch, dtype):
    batch = {name: torch.from_numpy(array.copy()) for name, array in batch.items()}
    batch["input"] = batch["input"].permute(0, 3, 1, 2).to(dtype) / 64
    batch["reward"] = batch["reward"].to(dtype)
    return batch


# --- files ---------------------------------------------------------------------------------------

DTYPES = {"F64": "<f8", "I64": "<i8", "F32": "<f4", "U8": "u1"}


def write_safetensors(path, tensors, metadata):
    tags = {np.dtype(code): tag for tag, code in DTYPES.items()}
    header, offset = {"__metadata__": metadata}, 0
    tensors = dict(sorted(tensors.items(), key=lambda item: -item[1].itemsize))  # keeps every tensor aligned
    for name, array in tensors.items():
        header[name] = {"dtype": tags[array.dtype], "shape": list(array.shape),
                        "data_offsets": [offset, offset + array.nbytes]}
        offset += array.nbytes
    text = json.dumps(header, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text)
        for array in tensors.values():
            file.write(np.ascontiguousarray(array).tobytes())


def read_safetensors(path):
    with open(path, "rb") as file:
        header = json.loads(file.read(struct.unpack("<Q", file.read(8))[0]))
        data = file.read()
    metadata = header.pop("__metadata__")
    view = lambda e: np.frombuffer(data[slice(*e["data_offsets"])], DTYPES[e["dtype"]]).reshape(e["shape"])
    return {name: view(entry) for name, entry in header.items()}, metadata


NORM_NAMES = {"weight": "scale", "bias": "shift", "running_mean": "mean", "running_var": "variance"}


def file_name(name):
    """PyTorch's name of a tensor -> ours."""
    head, _, last = name.rpartition(".")
    return f"{head}.{NORM_NAMES[last]}" if "norm" in head else name


def to_file(name, tensor):
    """PyTorch's layout -> ours: the input index before the output index, the output innermost."""
    tensor = tensor.detach()
    if tensor.dim() == 4:
        tensor = tensor.permute(2, 3, 1, 0)  # [ky, kx, in, out]
        tensor = tensor[0, 0] if ".shortcut." in name else tensor
    elif tensor.dim() == 2 and name.endswith(".weight"):
        tensor = tensor.t()
    return np.ascontiguousarray(tensor.float().numpy())


def from_file(name, array):
    tensor = torch.from_numpy(array.copy())
    if ".shortcut." in name:
        return tensor.t()[:, :, None, None]
    if tensor.dim() == 4:
        return tensor.permute(3, 2, 0, 1)
    return tensor.t() if tensor.dim() == 2 and name.endswith(".weight") else tensor


# --- dump and check ------------------------------------------------------------------------------

def step_results(net, batch, weights):
    """One training step. Returns what the file holds of it, and the smallest |input| of any ReLU."""
    margins = []
    hooks = [module.register_forward_pre_hook(lambda _, x: margins.append(x[0].detach().abs().min().item()))
             for module in net.modules() if isinstance(module, nn.ReLU)]
    net.train()
    losses, logits, psi = net.losses(batch, weights)
    losses[0].backward()
    result = {"loss": np.array([loss.item() for loss in losses]),
              "logits": to_file("", logits), "psi": to_file("", psi)}
    for name, p in net.named_parameters():
        result["grad." + file_name(name)] = to_file(name, p.grad)
    for name, b in net.named_buffers():
        if "running" in name:
            result["after." + file_name(name)] = to_file(name, b)
    net.eval()
    with torch.no_grad():
        result["eval_logits"] = to_file("", net.logits(batch))
    torch.optim.Adam(net.parameters(), **ADAM).step()
    for name, p in net.named_parameters():
        if p.numel() < ADAM_LIMIT:
            result["adam." + file_name(name)] = to_file(name, p)
    for hook in hooks:
        hook.remove()
    return result, min(margins)


def dump(args):
    widths = {key: getattr(args, key) or value for key, value in (FULL if args.full else NARROW).items()}
    batch_size = args.batch or (4 if args.full else 6)
    weights = (args.weight_env, args.weight_task)
    for seed in range(args.seed, args.seed + 1000):
        generator = torch.Generator().manual_seed(seed)
        net = SynPo(**widths)
        randomise(net, generator)
        net.double()
        tensors = {"param." + file_name(name): to_file(name, p) for name, p in net.named_parameters()}
        batch = random_batch(batch_size, widths["envs"], widths["tasks"], np.random.default_rng(seed),
                             pairs=2 * batch_size // 3 or 1)  # some pairs occur twice
        result, margin = step_results(net, to_torch(batch, torch.float64), weights)
        if margin > args.margin:
            break
    else:
        sys.exit("torch_reference: no seed keeps every ReLU input away from zero; lower --margin")
    metadata = {key: ",".join(map(str, value)) if key == "channels" else str(value) for key, value in widths.items()}
    metadata.update(weight_reward=str(REWARD_WEIGHT), weight_env=str(weights[0]), weight_task=str(weights[1]),
                    learning_rate=str(ADAM["lr"]), weight_decay=str(ADAM["weight_decay"]),
                    seed=str(seed), min_relu=f"{margin:.3g}")
    write_safetensors(args.output, {**tensors, **batch, **result}, metadata)
    print(f"seed {seed}, smallest |ReLU input| {margin:.3g}", file=sys.stderr)


def check(args):
    """Prints the worst relative error per kind of tensor; fails over 1e-4."""
    tensors, metadata = read_safetensors(args.file)
    widths = {key: int(metadata[key]) for key in FULL if key != "channels"}
    net = SynPo(tuple(map(int, metadata["channels"].split(","))), **widths)
    with torch.no_grad():
        for name, p in net.named_parameters():
            p.copy_(from_file(name, tensors["param." + file_name(name)]))
    batch = {name: tensors[name] for name in ("input", "env", "task", "label", "taken", "reward")}
    weights = (float(metadata["weight_env"]), float(metadata["weight_task"]))
    result, margin = step_results(net, to_torch(batch, torch.float32), weights)
    worst = {}
    for name, got in result.items():
        want = tensors[name]
        error = np.abs(got.astype(np.float64) - want).max() / np.abs(want).max()
        kind = name.split(".")[0]
        worst[kind] = max(worst.get(kind, (0, "")), (error, name))
    for error, name in worst.values():
        print(f"{error:.2e}\t{name}")
    print(f"smallest |ReLU input| {margin:.3g}", file=sys.stderr)
    if not max(worst.values())[0] < 1e-4:
        sys.exit("torch_reference: float32 and the file disagree")


# --- bench ---------------------------------------------------------------------------------------

def fast_blas():
    """Debian's fallback, the reference BLAS, multiplies at a fiftieth of OpenBLAS's rate."""
    with open("/proc/self/maps") as maps:
        text = maps.read()
    return any(name in text for name in ("openblas", "mkl_rt", "blis", "atlas"))


def fused(encoder):
    """A copy for evaluation with every norm folded into its convolution."""
    encoder = copy.deepcopy(encoder).eval()
    for block in [m for m in encoder.modules() if isinstance(m, Block)]:
        for conv, norm in (("conv1", "norm1"), ("conv2", "norm2"), ("shortcut", "shortcut_norm")):
            if isinstance(getattr(block, conv), nn.Conv2d):
                setattr(block, conv, fuse_conv_bn_eval(getattr(block, conv), getattr(block, norm)))
                setattr(block, norm, nn.Identity())
    return encoder


def make_step(mode, net, batches, memory_format, head, foreach):
    """A function that does one step on the next batch."""
    layout = torch.channels_last if memory_format == "channels_last" else torch.contiguous_format
    net = net.to(memory_format=layout)
    batches = itertools.cycle([{**b, "input": b["input"].contiguous(memory_format=layout)} for b in batches])
    head = getattr(SynPo, head)
    if mode == "forward":
        net.eval()
        net.encoder = fused(net.encoder)

        def forward():
            with torch.inference_mode():
                return net.logits(next(batches), head)
        return forward
    net.train()
    optimiser = torch.optim.Adam(net.parameters(), foreach=foreach, **ADAM)

    def train():
        optimiser.zero_grad(set_to_none=True)
        net.losses(next(batches), (0.1, 0.1), head)[0][0].backward()
        optimiser.step()
    return train


def step_times(step, seconds):
    """At least two steps, after one unmeasured."""
    step()
    times, end = [], time.perf_counter() + seconds
    while len(times) < 2 or time.perf_counter() < end:
        start = time.perf_counter()
        step()
        times.append(time.perf_counter() - start)
    return times


def bench(args):
    if not fast_blas():
        sys.exit("torch_reference: PyTorch runs on the reference BLAS, no fair comparison; install libopenblas0-openmp")
    # Keeps freed memory (no mmap, no trimming): fresh pages in every step would cost PyTorch some 7 %.
    libc = ctypes.CDLL(None)
    for option, value in ((-4, 0), (-1, 2**31 - 1), (-2, 1 << 26)):  # M_MMAP_MAX, M_TRIM_THRESHOLD, M_TOP_PAD
        libc.mallopt(option, value)
    torch.set_num_threads(args.threads)
    torch.set_flush_denormal(True)
    rng = np.random.default_rng(0)
    net = SynPo(**FULL)
    randomise(net, torch.Generator().manual_seed(0))
    batches = [to_torch(random_batch(args.batch, 20, 20, rng, pairs=144), torch.float32) for _ in range(2)]

    options = dict(memory_format=("channels_last", "contiguous"), head=("by_sum", "by_bmm", "by_matrix"),
                   foreach=(True, False) if args.mode == "train" else (None,))
    choice = {key: values[0] for key, values in options.items()}
    trial = lambda: min(step_times(make_step(args.mode, copy.deepcopy(net), batches, **choice), 0.5))
    best = trial()
    for key, values in options.items():  # one after the other: they hardly depend on each other
        for value in values[1:]:
            kept, choice[key] = choice[key], value
            seconds = trial()
            if seconds < best:
                best = seconds
            else:
                choice[key] = kept
    times = step_times(make_step(args.mode, net, batches, **choice), args.seconds)
    print("torch", torch.__version__, *(f"{key}={value}" for key, value in choice.items()),
          f"best={args.batch / min(times):.0f}", file=sys.stderr)
    print(f"{args.batch / statistics.median(times):.0f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    p = commands.add_parser("dump")
    p.add_argument("-o", "--output", required=True)
    p.add_argument("--full", action="store_true", help="full widths and a batch of 4 instead of narrow ones and 6")
    p.add_argument("--batch", type=int)
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--margin", type=float, default=3e-5, help="smallest |ReLU input| allowed: float32 must not flip it")
    p.add_argument("--weight-env", type=float, default=0.1)
    p.add_argument("--weight-task", type=float, default=0.1)
    p.add_argument("--channels", type=lambda text: tuple(map(int, text.split(","))))
    for name in ("feature", "basis", "embedding", "hidden", "envs", "tasks"):
        p.add_argument("--" + name, type=int)
    p = commands.add_parser("check")
    p.add_argument("file")
    p = commands.add_parser("bench")
    p.add_argument("--mode", choices=("train", "forward"), required=True)
    p.add_argument("--batch", type=int, required=True)
    p.add_argument("--threads", type=int, required=True)
    p.add_argument("--seconds", type=float, default=8)
    args = parser.parse_args()
    {"dump": dump, "check": check, "bench": bench}[args.command](args)


if __name__ == "__main__":
    main()
