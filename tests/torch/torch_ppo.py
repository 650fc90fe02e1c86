#!/usr/bin/python3
"""PPO of synpo in PyTorch: makes the numbers in tests/data that the tests compare with.

  torch_ppo.py dump -o FILE [--seed S]
      what PPO is made of, in float64 as safetensors: advantages, the clipped loss and its gradients, RMSProp;
      with the default seed tests/data/torch_ppo.safetensors
"""
import argparse
import itertools
import sys

sys.dont_write_bytecode = True  # no __pycache__ among the scripts
import numpy as np
import torch
import torch_reference as reference
from torch import nn
from torch.nn import functional as F

ACTIONS = reference.ACTIONS["pictures"]
GOES_ON, TERMINATED, TRUNCATED = range(3)
GAMMA, LAMBDA = 0.99, 0.95
CLIP, ENTROPY_WEIGHT, GRADIENT_NORM = 0.1, 0.01, 0.5
RMSPROP = dict(lr=0.01, alpha=0.99, eps=1e-8, weight_decay=0.1)  # steps so long that three of them show


def next_values(value, end, cut_value, last_value):
    """V of the state after each step, 0 after a terminal one."""
    following = torch.cat([value[1:], last_value[None]])
    return torch.where(end == TRUNCATED, cut_value, following) * (end != TERMINATED)


def advantages(reward, value, end, cut_value, last_value):
    """By the definition: the sum of (gamma lambda)^l delta_(t+l) up to the episode's end."""
    delta = reward + GAMMA * next_values(value, end, cut_value, last_value) - value
    result = torch.zeros_like(delta)
    for t, lane in itertools.product(*map(range, delta.shape)):
        for later in range(t, len(delta)):
            result[t, lane] += (GAMMA * LAMBDA) ** (later - t) * delta[later, lane]
            if end[later, lane] != GOES_ON:
                break
    return result


def advantage_results(rng, steps=9, lanes=3):
    """Lane 0 ends twice, lane 1 is cut and then ends with the rollout, lane 2 goes on."""
    end = np.zeros((steps, lanes), np.uint8)
    end[2, 0] = end[6, 0] = end[steps - 1, 1] = TERMINATED
    end[4, 1] = TRUNCATED
    draw = lambda *shape: rng.normal(size=shape).astype(np.float32)
    given = dict(reward=draw(steps, lanes), value=draw(steps, lanes), end=end, cut_value=draw(steps, lanes),
                 last_value=draw(lanes))
    tensors = {name: torch.from_numpy(array if name == "end" else array.astype(np.float64))
               for name, array in given.items()}
    return {**given, "advantage": advantages(**tensors).numpy()}


def ppo_losses(logits, action, old_log_probability, advantage, value, target):
    """Mean -objective, half-squared error of the value, and entropy."""
    distribution = torch.distributions.Categorical(logits=logits)
    ratio = (distribution.log_prob(action) - old_log_probability).exp()
    objective = torch.min(ratio * advantage, ratio.clamp(1 - CLIP, 1 + CLIP) * advantage)
    return -objective.mean(), 0.5 * F.mse_loss(value, target), distribution.entropy().mean(), ratio


def clipped_results(rng, count=24):
    """Ratios below, within and above the clip, for advantages of both signs, and off its edges by more than float32
    rounds."""
    draw = lambda *shape: rng.normal(size=shape).astype(np.float32)
    logits, action = draw(count, ACTIONS), rng.integers(0, ACTIONS, count)
    wanted = np.resize((0.6, 0.87, 0.93, 1.06, 1.13, 1.7), count) * rng.uniform(0.99, 1.01, count)
    advantage = np.abs(draw(count)) * np.where(np.arange(count) // 6 % 2, 1, -1).astype(np.float32)
    log_probability = F.log_softmax(torch.from_numpy(logits).double(), 1)[torch.arange(count),
                                                                          torch.from_numpy(action)].numpy()
    given = dict(logits=logits, action=action,
                 old_log_probability=(log_probability - np.log(wanted)).astype(np.float32),
                 advantage=advantage, predicted=draw(count), target=draw(count))
    tensors = {name: torch.from_numpy(array.astype(np.float64) if array.dtype == np.float32 else array)
               for name, array in given.items()}
    leaves = [tensors[name].requires_grad_() for name in ("logits", "predicted")]
    policy, value, entropy, ratio = ppo_losses(*tensors.values())
    (policy + value - ENTROPY_WEIGHT * entropy).backward()
    extremes = [(ratio - 1 - ratio.log()).mean(), ((ratio - 1).abs() > CLIP).double().mean(), ratio.max(), ratio.min()]
    return {**given, "losses": np.array([x.item() for x in (policy, value, entropy, *extremes)]),
            "dlogits": leaves[0].grad.numpy(), "dpredicted": leaves[1].grad.numpy()}


def rmsprop_results(rng, steps=3):
    """Gradients of two tensors, of which the last step's together are shorter than the clip."""
    draw = lambda *shape: rng.normal(size=shape)
    parameters = [nn.Parameter(torch.from_numpy(draw(count))) for count in (7, 4)]
    gradients = draw(steps, 11) * np.array([1, 3, 0.05])[:, None]
    joined = lambda tensors: torch.cat(tensors).detach().numpy().copy()
    start, after = joined(parameters), []
    optimiser = torch.optim.RMSprop(parameters, **RMSPROP)
    for gradient in torch.from_numpy(gradients):
        for parameter, part in zip(parameters, gradient.split((7, 4))):
            parameter.grad = part.clone()
        nn.utils.clip_grad_norm_(parameters, GRADIENT_NORM)
        optimiser.step()
        after.append(joined(parameters))
    square = joined([optimiser.state[parameter]["square_avg"] for parameter in parameters])
    return dict(parameter=start, gradient=gradients, after=np.stack(after), square=square)


def dump(args):
    rng = np.random.default_rng(args.seed)
    parts = dict(gae=advantage_results(rng), clip=clipped_results(rng), rmsprop=rmsprop_results(rng))
    tensors = {f"{part}.{name}": array for part, results in parts.items() for name, array in results.items()}
    metadata = dict(discount=GAMMA, **{"lambda": LAMBDA}, clip=CLIP, entropy=ENTROPY_WEIGHT,
                    gradient_norm=GRADIENT_NORM, **RMSPROP)
    reference.write_safetensors(args.output, tensors, {key: str(value) for key, value in metadata.items()})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    p = commands.add_parser("dump")
    p.add_argument("-o", "--output", required=True)
    p.add_argument("--seed", type=int, default=1)
    args = parser.parse_args()
    dump(args)


if __name__ == "__main__":
    main()
