#!/usr/bin/python3
"""The imitation-learning step of synpo in PyTorch: makes the numbers in tests/data that the tests compare with.

  torch_reference.py dump -o FILE [--method NAME] [--sight pictures|features] [--batch N] [--seed S] [widths]
      one training step in float64 on a random model and batch, as safetensors
  torch_reference.py committed -o tests/data
      the dumps that are in the tree
"""
import argparse
import json
import math
import struct
import sys
from types import SimpleNamespace

import numpy as np
import torch
from torch import nn
from torch.nn import functional as F

ACTIONS = dict(pictures=5, features=7)
STRIDES = (2, 2, 2, 1)
HISTORY, HAND = 4, 16  # views, and numbers about the hand after them
# Widths by sight: of pictures (GridWorld), of features (the kitchens).
NARROW_HEAD = dict(feature=16, basis=12, embedding=10, hidden=24, action_embedding=0, head_hidden=20, seam=6, envs=4,
                   tasks=5)
NARROW = dict(pictures=dict(channels=(8, 16, 24, 32), **NARROW_HEAD),
              features=dict(view=20, view_channels=18, objects=4, object_embedding=3, view_hidden=21, **NARROW_HEAD))
FULL_HEAD = dict(basis=128, embedding=128, hidden=512, action_embedding=0, head_hidden=1024, seam=32)
FULL = dict(pictures=dict(channels=(32, 64, 128, 256), feature=128, envs=20, tasks=20, **FULL_HEAD),
            features=dict(view=2048, view_channels=1024, objects=8, object_embedding=32, view_hidden=2048, feature=256,
                          envs=19, tasks=21,
                          **FULL_HEAD))
SMALL = "--channels 4,4,4,5 "
FEATURES = "--sight features "
COMMITTED = dict(narrow="", general=SMALL + "--action-embedding 3", mtl=SMALL + "--method mtl",
                 mtl_general=SMALL + "--method mtl --action-embedding 7", mlp=SMALL + "--method mlp",
                 modulenet=SMALL + "--method modulenet", sf_td=SMALL + "--method sf",
                 sf_q=SMALL + "--method sf --sf-loss q",
                 sf_ce=SMALL + "--method sf --sf-loss ce", temporal=FEATURES, temporal_mlp=FEATURES + "--method mlp")
REWARD_WEIGHT = 0.01
DISCOUNT = 0.9
TERMINAL, UNKNOWN = -1, -2  # in place of the next step
ADAM = dict(lr=0.001, betas=(0.9, 0.999), eps=1e-8, weight_decay=0.001)
ADAM_LIMIT = 2100  # larger tensors get no adam.NAME, which keeps the committed file small


# --- the methods ---------------------------------------------------------------------------------

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


class TemporalEncoder(nn.Module):
    """psi(s) of Table 3: [N, HISTORY * view + HAND] -> [N, d]. The views stand oldest first; after them the number of
    what the hand holds."""

    def __init__(self, w):
        super().__init__()
        self.conv1 = nn.Conv1d(w.view, w.view_channels, 3, 2, 1)
        self.relu1 = nn.ReLU(inplace=True)
        self.conv2 = nn.Conv1d(w.view_channels, w.view_channels, 3, 2, 1)
        self.relu2 = nn.ReLU(inplace=True)
        self.object = empty(w.objects, w.object_embedding)
        self.fc = Mlp(w.view_channels + w.object_embedding, w.view_hidden, w.feature)

    def convolve(self, x):
        x = x.view(len(x), HISTORY, -1).transpose(1, 2)
        return self.relu2(self.conv2(self.relu1(self.conv1(x)))).flatten(1)

    def forward(self, x):
        return self.fc(torch.cat([self.convolve(x[:, :-HAND]), self.object[x[:, -HAND].long()]], 1))


class Mlp(nn.Module):
    def __init__(self, inputs, hidden, outputs):
        super().__init__()
        self.hidden = nn.Linear(inputs, hidden)
        self.relu = nn.ReLU(inplace=True)
        self.out = nn.Linear(hidden, outputs)

    def forward(self, x):
        return self.out(self.relu(self.hidden(x)))


def empty(*shape):
    return nn.Parameter(torch.zeros(*shape))


def widths(sizes, sight, **others):
    """A method's widths."""
    return SimpleNamespace(**sizes, sight=sight, actions=ACTIONS[sight], **others)


class Policy(nn.Module):
    """What methods share: encoder, embeddings (of "env", "task"), the losses of reward and disentanglement.

    A method has outputs(batch): logits and whatever its losses(batch) needs; losses by name, without weights."""

    def __init__(self, w, embeddings):
        super().__init__()
        self.w = w
        self.encoder = Encoder(w.channels, w.feature) if w.sight == "pictures" else TemporalEncoder(w)
        if embeddings:
            self.embedding = nn.ParameterDict({name: empty(getattr(w, name + "s"), w.embedding) for name in embeddings})

    def embedded(self, batch):
        return torch.cat([table[batch[name]] for name, table in self.embedding.items()], 1)

    def told(self, x, name, batch):
        """The loss of telling from f(x) what environment, or task, it comes from."""
        return F.cross_entropy(getattr(self, "f_" + name)(x) @ self.embedding[name].t(), batch[name])

    def summed(self):
        """Perceptrons whose outputs go into a sum, with its number of terms."""
        return ()


class SynPo(Policy):
    def __init__(self, w, embeddings=("env", "task")):
        super().__init__(w, embeddings)
        self.alpha = Mlp(len(embeddings) * w.embedding, w.hidden, w.basis)
        self.beta = Mlp(len(embeddings) * w.embedding, w.hidden, w.basis)
        self.theta = empty(w.action_embedding or w.actions, w.feature, w.basis)
        if w.action_embedding:
            self.phi = empty(w.actions, w.action_embedding)
        self.policy = nn.ParameterDict({"bias": empty(w.actions)})
        self.reward = nn.ParameterDict({"bias": empty(w.actions)})
        for name in embeddings:
            self.add_module("f_" + name, Mlp(w.basis, w.hidden, w.embedding))

    def summed(self):
        return [(self.alpha, self.w.basis), (self.beta, self.w.basis)] + [(getattr(self, "f_" + n), self.w.embedding)
                                                                          for n in self.embedding]

    def pairs(self, batch):
        """Distinct pairs (for MTL tasks) as one row of embeddings each [P, E], and each state's row [N]."""
        pairs, index = torch.unique(torch.stack([batch[name] for name in self.embedding], 1), dim=0,
                                    return_inverse=True)
        return self.embedded(dict(zip(self.embedding, pairs.t()))), index

    def matrices(self):
        """Theta phi(a): [A, d, K]."""
        return torch.einsum("aD,Ddk->adk", self.phi, self.theta) if self.w.action_embedding else self.theta

    def products(self, psi):
        """psi^T Theta phi(a) for every action: [N, A, K]."""
        theta = self.matrices()
        actions, feature, basis = theta.shape
        return (psi @ theta.permute(1, 0, 2).reshape(feature, actions * basis)).view(-1, actions, basis)

    @staticmethod
    def weigh(products, coefficients, index):
        """psi^T (sum_k coefficient_k Theta_k) phi(a) as [N, A], of coefficients [P, K] and each state's pair [N]."""
        return (products * coefficients[index].unsqueeze(1)).sum(2)

    def logits(self, batch):
        pairs, index = self.pairs(batch)
        return self.weigh(self.products(self.encoder(batch["input"])), self.alpha(pairs), index) + self.policy["bias"]

    def losses(self, batch):
        psi = self.encoder(batch["input"])
        products = self.products(psi)
        pairs, index = self.pairs(batch)
        rows, taken = torch.arange(len(psi)), batch["taken"]
        logits = self.weigh(products, self.alpha(pairs), index) + self.policy["bias"]
        reward = (products[rows, taken] * self.beta(pairs)[index]).sum(1) + self.reward["bias"][taken]
        x = products[rows, batch["label"]]
        losses = dict(policy=F.cross_entropy(logits, batch["label"]), reward=F.mse_loss(reward, batch["reward"]))
        return {**losses, **{name: self.told(x, name, batch) for name in self.embedding}}, logits, psi


class MultiTask(SynPo):
    def __init__(self, w):
        super().__init__(w, ("task",))


class OneMlp(Policy):
    def __init__(self, w):
        super().__init__(w, ("env", "task"))
        self.policy = Mlp(w.feature + 2 * w.embedding, w.head_hidden, w.actions)
        self.reward = Mlp(w.feature + 2 * w.embedding, w.head_hidden, w.actions)
        self.f_env = Mlp(w.feature, w.hidden, w.embedding)
        self.f_task = Mlp(w.feature, w.hidden, w.embedding)

    def summed(self):
        return (self.f_env, self.w.embedding), (self.f_task, self.w.embedding)

    def logits(self, batch):
        return self.policy(torch.cat([F.normalize(self.encoder(batch["input"])), self.embedded(batch)], 1))

    def losses(self, batch):
        psi = self.encoder(batch["input"])
        unit = F.normalize(psi)
        x = torch.cat([unit, self.embedded(batch)], 1)
        logits = self.policy(x)
        reward = self.reward(x)[torch.arange(len(x)), batch["taken"]]
        losses = dict(policy=F.cross_entropy(logits, batch["label"]), reward=F.mse_loss(reward, batch["reward"]))
        return {**losses, "env": self.told(unit, "env", batch), "task": self.told(unit, "task", batch)}, logits, psi


class ModuleNet(Policy):
    """Without dropout: its random numbers are not ours."""

    def __init__(self, w):
        super().__init__(w, ())
        modules = {f"task{i}": Mlp(w.feature, w.head_hidden, w.seam) for i in range(w.tasks)}
        modules.update({f"env{i}": Mlp(w.seam, w.head_hidden, w.actions) for i in range(w.envs)})
        self.module = nn.ModuleDict(modules)

    def each(self, kind, x, batch):
        return torch.stack([self.module[f"{kind}{key}"](row) for key, row in zip(batch[kind].tolist(), x)])

    def scores(self, psi, batch):
        return self.each("env", self.each("task", psi, batch), batch)

    def logits(self, batch):
        return self.scores(self.encoder(batch["input"]), batch)

    def losses(self, batch):
        psi = self.encoder(batch["input"])
        logits = self.scores(psi, batch)
        return dict(policy=F.cross_entropy(logits, batch["label"])), logits, psi


class SuccessorFeatures(Policy):
    def __init__(self, w):
        super().__init__(w, ("env", "task"))
        self.phi = Mlp(w.feature, w.head_hidden, w.actions * w.embedding)
        self.psi = Mlp(w.feature + 2 * w.embedding, w.head_hidden, w.actions * w.embedding)

    def summed(self):
        return (self.phi, self.w.embedding), (self.psi, self.w.embedding)

    def features(self, feature, batch):
        """psi(s, a; z): [N, A, E]."""
        return self.psi(torch.cat([feature, self.embedded(batch)], 1)).view(len(feature), self.w.actions, -1)

    def values(self, psi, batch):
        return (psi * self.embedding["task"][batch["task"]].unsqueeze(1)).sum(2)

    def logits(self, batch):
        return self.values(self.features(self.encoder(batch["input"]), batch), batch)

    def temporal_difference(self, phi, psi, batch):
        following = batch["next"].clamp(min=0)
        psi_next = psi[following, batch["label"][following]] * (batch["next"] != TERMINAL).unsqueeze(1)
        taken = psi[torch.arange(len(psi)), batch["taken"]]
        known = batch["next"] != UNKNOWN
        return F.mse_loss(taken[known], (phi + DISCOUNT * psi_next)[known].detach())

    def losses(self, batch):
        feature = self.encoder(batch["input"])
        phi = self.phi(feature).view(len(feature), self.w.actions, -1)[torch.arange(len(feature)), batch["taken"]]
        psi = self.features(feature, batch)
        q = self.values(psi, batch)
        policy_loss = {"td": lambda: self.temporal_difference(phi, psi, batch),
                       "q": lambda: F.mse_loss(q, batch["planner_q"]),
                       "ce": lambda: F.cross_entropy(q, batch["label"])}[self.w.sf_loss]()
        reward = (phi * self.embedding["task"][batch["task"]]).sum(1)
        return dict(policy=policy_loss, reward=F.mse_loss(reward, batch["reward"])), q, feature


METHODS = dict(synpo=SynPo, mtl=MultiTask, mlp=OneMlp, modulenet=ModuleNet, sf=SuccessorFeatures)


def total(losses, weights):
    return sum(weights[name] * loss for name, loss in losses.items())


def randomise(net, generator):
    """Random parameters under which activations are O(1) and nothing is zero that training would move."""
    normal = lambda p, sd, mean=0.0: p.copy_(mean + sd * torch.randn(p.shape, generator=generator))
    with torch.no_grad():
        for name, p in net.named_parameters():
            if "norm" in name:
                normal(p, 0.2, 1.0 if name.endswith("weight") else 0.0)
            elif name.endswith("bias"):
                normal(p, 0.1)
            elif name.endswith("weight"):
                normal(p, math.sqrt((1 if "fc" in name else 2) / p[0].numel()))
            elif name in ("theta", "phi"):
                normal(p, 1 / math.sqrt(p.shape[1]))
            else:
                normal(p, 1)  # embeddings
        for head, width in net.summed():
            head.out.weight /= math.sqrt(width)


# --- batches -------------------------------------------------------------------------------------

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


def features(count, w, rng):
    """[N, HISTORY * view + HAND] F32, as TemporalEncoder takes it."""
    views = rng.random((count, HISTORY, w.view), np.float32)
    for view in views:
        view[:rng.choice((0, 0, 0, 1, 2, 3))] = 0  # at an episode's start there are no earlier ones
    hand = np.zeros((count, HAND), np.float32)
    hand[:, 0] = rng.integers(0, w.objects, count)
    return np.concatenate([views.reshape(count, -1), hand], 1)


def random_batch(count, w, rng, pairs=None):
    """Arrays as they stand in the file; pairs: draw from that many distinct pairs only."""
    pair = rng.choice(rng.permutation(w.envs * w.tasks)[:pairs], count)
    label = rng.integers(0, w.actions, count)
    taken = np.where(rng.random(count) < 0.5, rng.integers(0, w.actions, count), label)
    if count > 1 and (taken == label).all():
        taken[0] = (label[0] + 1) % w.actions
    seen = pictures(count, rng) if w.sight == "pictures" else features(count, w, rng)
    return dict(input=seen, env=pair // w.tasks, task=pair % w.tasks, label=label, taken=taken,
                reward=rng.choice((-0.01, -0.02, 0.99, 10.99, -10.01), count).astype(np.float32))


def future(batch, w, rng):
    """What SF's losses ask for besides: the next step, or what stands in its place, and the planner's values."""
    count = len(batch["env"])
    return dict(next=np.concatenate([[TERMINAL, UNKNOWN], rng.integers(0, count, count - 2)]),
                planner_q=rng.normal(size=(count, w.actions)).astype(np.float32))


def to_torch(batch, dtype):
    batch = {name: torch.from_numpy(array.copy()) for name, array in batch.items()}
    if batch["input"].dim() == 4:
        batch["input"] = batch["input"].permute(0, 3, 1, 2).to(dtype) / 64
    return {name: tensor.to(dtype) if tensor.is_floating_point() else tensor for name, tensor in batch.items()}


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
    elif tensor.dim() == 3 and name.endswith(".weight"):
        tensor = tensor.permute(2, 1, 0)  # [tap, in, out]
    elif tensor.dim() == 2 and name.endswith(".weight"):
        tensor = tensor.t()
    return np.ascontiguousarray(tensor.float().numpy())


# --- dump ----------------------------------------------------------------------------------------

def step_results(net, batch, weights):
    """One training step. Returns what the file holds of it, and the smallest |input| of any ReLU."""
    margins = []
    hooks = [module.register_forward_pre_hook(lambda _, x: margins.append(x[0].detach().abs().min().item()))
             for module in net.modules() if isinstance(module, nn.ReLU)]
    net.train()
    losses, logits, psi = net.losses(batch)
    loss = total(losses, weights)
    loss.backward()
    result = {"loss": np.array([loss.item()]
                               + [losses[name].item() if name in losses else math.nan for name in weights]),
              "logits": to_file("", logits), "psi": to_file("", psi)}
    for name, p in net.named_parameters():
        p.grad = torch.zeros_like(p) if p.grad is None else p.grad  # a module without samples
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
    sizes = {key: value if getattr(args, key) is None else getattr(args, key)
             for key, value in (FULL if args.full else NARROW)[args.sight].items()}
    shape = widths(sizes, args.sight, sf_loss=args.sf_loss)
    batch_size = args.batch or (4 if args.full else 6)
    weights = dict(policy=1, reward=REWARD_WEIGHT, env=args.weight_env, task=args.weight_task)
    for seed in range(args.seed, args.seed + 1000):
        generator = torch.Generator().manual_seed(seed)
        net = METHODS[args.method](shape)
        randomise(net, generator)
        net.double()
        tensors = {"param." + file_name(name): to_file(name, p) for name, p in net.named_parameters()}
        rng = np.random.default_rng(seed)
        batch = random_batch(batch_size, shape, rng, pairs=2 * batch_size // 3 or 1)  # some pairs occur twice
        if args.method == "sf":
            batch.update(future(batch, shape, rng))
        result, margin = step_results(net, to_torch(batch, torch.float64), weights)
        if margin > args.margin:
            break
    else:
        sys.exit("torch_reference: no seed keeps every ReLU input away from zero; lower --margin")
    metadata = {key: ",".join(map(str, value)) if key == "channels" else str(value) for key, value in sizes.items()}
    metadata.update({"weight_" + name: str(weight) for name, weight in weights.items() if name != "policy"})
    metadata.update(method=args.method, sf_loss=args.sf_loss, discount=str(DISCOUNT), learning_rate=str(ADAM["lr"]),
                    weight_decay=str(ADAM["weight_decay"]), seed=str(seed), min_relu=f"{margin:.3g}")
    write_safetensors(args.output, {**tensors, **batch, **result}, metadata)
    print(f"seed {seed}, smallest |ReLU input| {margin:.3g}", file=sys.stderr)


def parse(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    p = commands.add_parser("dump")
    p.add_argument("-o", "--output", required=True)
    p.add_argument("--method", choices=METHODS, default="synpo")
    p.add_argument("--sight", choices=ACTIONS, default="pictures")
    p.add_argument("--sf-loss", choices=("td", "q", "ce"), default="td")
    p.add_argument("--full", action="store_true", help="full widths and a batch of 4 instead of narrow ones and 6")
    p.add_argument("--batch", type=int)
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--margin", type=float, default=3e-5, help="smallest |ReLU input| allowed: float32 must not flip it")
    p.add_argument("--weight-env", type=float, default=0.1)
    p.add_argument("--weight-task", type=float, default=0.1)
    p.add_argument("--channels", type=lambda text: tuple(map(int, text.split(","))))
    for name in sorted({*FULL["pictures"], *FULL["features"]} - {"channels"}):
        p.add_argument("--" + name.replace("_", "-"), type=int)
    p = commands.add_parser("committed")
    p.add_argument("-o", "--output", required=True, help="folder")
    return parser.parse_args(arguments)


def committed(args):
    for name, options in COMMITTED.items():
        dump(parse(["dump", "-o", f"{args.output}/torch_{name}.safetensors", *options.split()]))


def main():
    args = parse(sys.argv[1:])
    {"dump": dump, "committed": committed}[args.command](args)


if __name__ == "__main__":
    main()
