#!/usr/bin/env python3
"""Other ways to a new maze's or task's embedding than synpo-finetune adapt: what lab/book.md compares with it.

    PYTHONPATH=python lab/adapt/embeddings.py OLD BASE DEMONSTRATIONS WORLD PREFIX [WAY...]
    PYTHONPATH=python lab/adapt/embeddings.py --basis NOISE EPISODES OLD BASE DEMONSTRATIONS WORLD PREFIX [WAY...]

OLD is the trained checkpoint, BASE the same made wider for WORLD's mazes (synpo-finetune adapt -n 1), DEMONSTRATIONS
synpo-gen-expert's episodes of the new pairs. PREFIX-WAY.ckpt gets BASE's tensors but for the rows that are new, and the
loss of the demonstrations is printed: the mean cross-entropy of a step. The ways:

    mean         the mean of the old embeddings
    likeliest    the old embedding under which the demonstrations are likeliest
    convex       the likeliest combination of old ones, weights from 0 that sum to 1
    learned      from N(0, s^2), s that of the old ones; 2,000 updates of Adam on all steps, decay 0.001
    from-mean, from-likeliest    the same from these starts
    weighted     as learned, steps weighted as training draws them: 0.3 but where the agent stands on a treasure
    near         as from-mean, held to the old ones by their variance: a Gaussian prior in the place of the decay

With --basis, alpha, theta, the policy's bias and the old embeddings are learned further first, from EPISODES of OLD's
own pairs (synpo-eval --record; the labels are learned) and 3,000 updates of 512 steps, with N(0, (NOISE s)^2) added to
every entry of the embeddings of each step. psi stays as it is.

Where both sides of a pair are new, likeliest goes to and fro between mazes and tasks until nothing changes.
"""
import json
import struct
import sys

import numpy as np
import synpo
import torch

torch.set_num_threads(1)
torch.manual_seed(1)


def moves_of(server):
    names = {"LEFT": (0, -1), "RIGHT": (0, 1), "UP": (-1, 0), "DOWN": (1, 0)}
    return [names.get(action) for action in server.actions]


def read(policy, path, world, starts="expert"):
    """psi [steps, d], env, task, label [steps], and whether the agent stands on a treasure."""
    server = synpo.Server(world)
    moves = moves_of(server)
    psi, env, task, label, choice = [], [], [], [], []
    for episode in synpo.read_trajectories(path):
        e, t = server.envs.index(episode["env"]), server.tasks.index(episode["task"])
        seen = [server.reset(0, e, t, episode["seed"], episode["episode"], starts)]
        at = list(episode["start"]["agent"])
        lie = {tuple(v) for k, v in episode["start"].items() if k != "agent"}
        for action, wanted in zip(episode["actions"], episode["labels"]):
            env.append(policy.envs.index(episode["env"]))
            task.append(policy.tasks.index(episode["task"]))
            label.append(int(wanted))
            choice.append(tuple(at) in lie)
            observation, _, _, _, _ = server.step([0], [action])
            seen.append(observation[0])
            if moves[action] is None:
                lie.discard(tuple(at))
            else:
                at = [at[0] + moves[action][0], at[1] + moves[action][1]]
        with torch.no_grad():
            psi.append(policy.encoder(torch.as_tensor(np.stack(seen[:-1]))))
    server.close()
    return torch.cat(psi), torch.tensor(env), torch.tensor(task), torch.tensor(label), torch.tensor(choice)


class Problem:
    def __init__(self, old, policy, data):
        psi, self.env, self.task, self.label, self.choice = data
        with torch.no_grad():
            self.mixed = torch.einsum("ni,aik->nak", psi, policy.matrices())
        self.policy = policy
        self.tables = {"env": policy.embedding["env"].data, "task": policy.embedding["task"].data}
        names = {"env": policy.envs, "task": policy.tasks}
        index = {"env": 0, "task": 1}
        self.old = {side: sorted({names[side].index(pair[index[side]]) for pair in old.seen}) for side in names}
        self.new = {side: sorted(set(range(len(names[side]))) - set(self.old[side])) for side in names}
        pairs, self.pair = torch.stack([self.env, self.task], 1).unique(dim=0, return_inverse=True)
        self.pair_env, self.pair_task = pairs[:, 0], pairs[:, 1]

    def step_losses(self, tables):
        z = torch.cat([tables["env"][self.pair_env], tables["task"][self.pair_task]], 1)
        scores = (self.mixed * self.policy.alpha(z)[self.pair][:, None]).sum(2) + self.policy.policy["bias"]
        return torch.nn.functional.cross_entropy(scores, self.label, reduction="none")

    def with_rows(self, rows):
        """The tables with `rows` {side: [new, width]} in the new places."""
        return {side: table.index_copy(0, torch.tensor(self.new[side]), rows[side]) if self.new[side] else table
                for side, table in self.tables.items()}

    def start(self, rows_of):
        return {side: rows_of(self.tables[side][self.old[side]], len(self.new[side])) for side in self.tables}

    def mean(self):
        return self.start(lambda old, n: old.mean(0).repeat(n, 1))

    def likeliest(self):
        rows, chosen = self.mean(), {}
        for _ in range(6):
            before = dict(chosen)
            for side, of in (("env", self.env), ("task", self.task)):
                if not self.new[side]:
                    continue
                losses = []
                for old in self.old[side]:
                    trial = dict(rows)
                    trial[side] = self.tables[side][old].repeat(len(self.new[side]), 1)
                    with torch.no_grad():
                        step = self.step_losses(self.with_rows(trial))
                    losses.append(torch.stack([step[of == new].mean() for new in self.new[side]]))
                best = torch.stack(losses).argmin(0)
                rows[side] = self.tables[side][torch.tensor(self.old[side])[best]]
                chosen[side] = best.tolist()
            if before == chosen:
                break
        return rows

    def convex(self):
        weights = {side: torch.zeros(len(self.new[side]), len(self.old[side]), requires_grad=True)
                   for side in self.tables}
        best = torch.optim.Adam(list(weights.values()), lr=0.05)

        def rows():
            return {side: torch.softmax(w, 1) @ self.tables[side][self.old[side]] for side, w in weights.items()}
        for _ in range(1500):
            best.zero_grad()
            self.step_losses(self.with_rows(rows())).mean().backward()
            best.step()
        return {side: value.detach() for side, value in rows().items()}

    def learned(self, start, weight=None, decay=0.001, prior=0.0, updates=2000):
        centre = self.mean()
        rows = {side: value.clone().requires_grad_() for side, value in start.items()}
        best = torch.optim.Adam(list(rows.values()), lr=0.001, weight_decay=decay)
        for _ in range(updates):
            best.zero_grad()
            losses = self.step_losses(self.with_rows(rows))
            loss = losses.mean() if weight is None else (losses * weight).sum() / weight.sum()
            if prior:
                for side, value in rows.items():
                    sd = self.tables[side][self.old[side]].std(0)
                    loss = loss + prior * (((value - centre[side]) / sd) ** 2).sum() / (2 * len(losses))
            loss.backward()
            best.step()
        return {side: value.detach() for side, value in rows.items()}

    def way(self, name):
        like_old = self.start(lambda old, n: old.std() * torch.randn(n, old.shape[1]))
        if name == "weighted":
            return self.learned(like_old, torch.where(self.choice, 1.0, 0.3))
        return {"mean": self.mean, "likeliest": self.likeliest, "convex": self.convex,
                "learned": lambda: self.learned(like_old),
                "from-mean": lambda: self.learned(self.mean()),
                "from-likeliest": lambda: self.learned(self.likeliest()),
                "near": lambda: self.learned(self.mean(), decay=0, prior=1.0)}[name]()


def train_basis(policy, data, noise, updates=3000, batch=512):
    """Learns alpha, theta, the policy's bias and the embeddings further, and prints how well."""
    psi, env, task, label, _ = data
    learned = [*policy.alpha.parameters(), policy.theta, policy.policy["bias"], *policy.embedding.values()]
    for parameter in learned:
        parameter.requires_grad_(True)
    scale = {side: noise * table.data[table.data.norm(dim=1) > 0].std() for side, table in policy.embedding.items()}
    best = torch.optim.Adam(learned, lr=0.001)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(best, updates)
    held = len(label) // 10
    order = torch.randperm(len(label))

    def scores(rows, noisy):
        z = [policy.embedding[side][index[rows]] for side, index in (("env", env), ("task", task))]
        if noisy:
            z = [value + scale[side] * torch.randn_like(value) for side, value in zip(("env", "task"), z)]
        return (torch.einsum("ni,aik,nk->na", psi[rows], policy.matrices(), policy.alpha(torch.cat(z, 1)))
                + policy.policy["bias"])

    def right():
        with torch.no_grad():
            return (scores(order[:held], False).argmax(1) == label[order[:held]]).float().mean()
    first = right()
    for _ in range(updates):
        rows = order[held + torch.randint(len(order) - held, (batch,))]
        best.zero_grad()
        torch.nn.functional.cross_entropy(scores(rows, noise > 0), label[rows]).backward()
        best.step()
        schedule.step()
    print(f"basis: {len(label)} steps; of {held} held back the best action is right in {100 * first:.1f} % before and "
          f"{100 * right():.1f} % after", flush=True)
    for parameter in learned:
        parameter.requires_grad_(False)


def write(path, like, tables):
    """The checkpoint file `like` with other tensors."""
    with open(like, "rb") as file:
        size, = struct.unpack("<Q", file.read(8))
        text = file.read(size)
        data = bytearray(file.read())
    header = json.loads(text)
    for name, table in tables.items():
        entry = header[name]
        assert entry["dtype"] == "F32" and list(table.shape) == entry["shape"], name
        begin, end = entry["data_offsets"]
        data[begin:end] = table.numpy().astype("<f4").tobytes()
    with open(path, "wb") as file:
        file.write(struct.pack("<Q", size) + text + data)


def main():
    words = sys.argv[1:]
    basis = words[1:3] if words[0] == "--basis" else None
    old, base, demonstrations, world, prefix, *ways = words[3 * bool(basis):]
    policy = synpo.load_policy(base)
    for parameter in policy.parameters():
        parameter.requires_grad_(False)
    changed = {}
    if basis:
        # An episode that synpo-eval records starts as one of its own.
        own = read(policy, basis[1], "gridworld", "evaluation")
        train_basis(policy, own, float(basis[0]))
        changed = {f"alpha.{layer}.{part}": getattr(getattr(policy.alpha, layer), part).data
                   for layer in ("hidden", "out") for part in ("weight", "bias")}
        changed = {name: value.T.contiguous() if name.endswith("weight") else value for name, value in changed.items()}
        changed.update({"theta": policy.theta.data, "policy.bias": policy.policy["bias"].data})
    problem = Problem(synpo.read_checkpoint(old), policy, read(policy, demonstrations, world))
    print(f"{len(problem.label)} steps, {int(problem.choice.sum())} of them on a treasure; new: "
          f"{len(problem.new['env'])} mazes, {len(problem.new['task'])} tasks")
    print("way\tloss\tlength, maze\tlength, task")
    for name in ways or ["mean", "likeliest", "convex", "learned", "from-mean", "from-likeliest", "weighted", "near"]:
        rows = problem.way(name)
        tables = problem.with_rows(rows)
        with torch.no_grad():
            loss = problem.step_losses(tables).mean()
        lengths = [f"{value.norm(dim=1).mean():.2f}" if len(value) else "" for value in rows.values()]
        print(f"{name}\t{loss:.3f}\t" + "\t".join(lengths), flush=True)
        write(f"{prefix}-{name}.ckpt", base,
              {**changed, **{"embedding." + side: table for side, table in tables.items()}})


main()
