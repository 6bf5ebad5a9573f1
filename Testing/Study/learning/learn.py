#!/usr/bin/env python3
"""learn.py {classify|segment} --train NAME=SOURCE... [--test NAME=SOURCE...] [--out FOLDER]: trains a network on each
training set, tests each on what it holds out and on the test sets, and writes results.json and results.md.

A SOURCE is a data set's folder of SonoVDB, or KIND:FOLDER with sonovdb, camus, echonet or views. See README.md.
"""

import argparse
import json
import statistics
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy
import torch
from torch.nn import functional

import augment
import networks
from examples import STRUCTURES, VIEWS, Unreadable, read
from scores import dice, macro_f1


def load(examples, device, masks):
    """Pictures, and masks or views, as bytes on the device."""
    with ThreadPoolExecutor() as pool:
        pictures = torch.from_numpy(numpy.stack(list(pool.map(lambda e: e.picture(), examples)))).to(device)
        if masks:
            truth = torch.from_numpy(numpy.stack(list(pool.map(lambda e: e.mask(), examples)))).to(device)
        else:
            truth = torch.tensor([VIEWS.index(e.view) for e in examples], device=device)
    return pictures, truth


def shown(pictures):
    """Of mean 0 and deviation 1 where there is a picture."""
    fan = pictures > 0
    count = fan.sum(dim=(1, 2, 3), keepdim=True).clamp(min=1)
    mean = (pictures * fan).sum(dim=(1, 2, 3), keepdim=True) / count
    variance = (((pictures - mean) * fan) ** 2).sum(dim=(1, 2, 3), keepdim=True) / count
    return (pictures - mean) * fan / (variance.sqrt() + 1e-6)


def segmentation_loss(logits, masks):
    """Cross entropy, and one minus the mean soft Dice of the structures over the batch."""
    shares = torch.softmax(logits, dim=1)
    truth = functional.one_hot(masks, len(STRUCTURES)).permute(0, 3, 1, 2).float()
    both = (shares * truth).sum(dim=(0, 2, 3))[1:]
    all_of_them = (shares + truth).sum(dim=(0, 2, 3))[1:]
    return functional.cross_entropy(logits, masks) + 1.0 - ((2.0 * both + 1.0) / (all_of_them + 1.0)).mean()


def balanced(truth, views):
    """A number of each example: views that are rare are drawn as often as the others."""
    if not views:
        return torch.ones(len(truth), device=truth.device)
    counts = torch.bincount(truth, minlength=len(VIEWS)).float()
    return 1.0 / counts[truth]


def train(task, pictures, truth, steps, batch, seed):
    torch.manual_seed(seed)
    views = task == "classify"
    network = (networks.view_network(len(VIEWS)) if views else networks.UNet(len(STRUCTURES))).to(pictures.device)
    optimizer = torch.optim.AdamW(network.parameters(), lr=1e-3, weight_decay=1e-2)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimizer, max_lr=1e-3, total_steps=steps)
    weights = balanced(truth, views)
    half = torch.bfloat16
    network.train()
    for _ in range(steps):
        chosen = torch.multinomial(weights, batch, replacement=True)
        x = pictures[chosen][:, None].float() / 255.0
        y = truth[chosen].long()
        x, moved = augment.lay_anew(x, None if views else y)
        x = shown(augment.show_anew(x))
        with torch.autocast(pictures.device.type, dtype=half):
            logits = network(x)
        loss = functional.cross_entropy(logits.float(), y) if views else segmentation_loss(logits.float(), moved)
        optimizer.zero_grad(set_to_none=True)
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 5.0)
        optimizer.step()
        schedule.step()
    return network.eval()


@torch.no_grad()
def guesses(network, pictures, batch):
    """The likeliest class, of the picture and its mirror image together."""
    best = []
    for part in torch.split(pictures, batch):
        x = shown(part[:, None].float() / 255.0)
        logits = network(x).softmax(1)
        mirrored = network(x.flip(-1)).softmax(1)
        best.append((logits + (mirrored.flip(-1) if mirrored.dim() == 4 else mirrored)).argmax(1))
    return torch.cat(best)


def score(task, network, examples, pictures, truth, batch):
    found = guesses(network, pictures, batch).cpu().numpy()
    truth = truth.cpu().numpy()
    if task == "classify":
        return macro_f1(found, truth, len(VIEWS))
    return {
        STRUCTURES[s]: dice(found, truth, s, [s in e.marked for e in examples])
        for s in range(1, len(STRUCTURES))
    }


def summary(scores):
    """Mean and spread over the seeds, figure by figure."""
    result = {}
    for key in scores[0]:
        values = [s[key] for s in scores if s[key] is not None]
        if values:
            result[key] = {"mean": statistics.fmean(values), "sd": statistics.pstdev(values), "seeds": values}
    return result


def usable(examples, task, training):
    """Those that have what the task needs: a known view; a mask, with every structure where a network learns."""
    if task == "classify":
        return [e for e in examples if e.view in VIEWS]
    return [e for e in examples if e.mask and (len(e.marked) == len(STRUCTURES) - 1 or not training)]


def named(text):
    name, equals, source = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=SOURCE")
    return name, source


def table(results):
    lines = [
        "| trained on | pictures | tested on | pictures | figure | mean | SD over seeds |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in results["rows"]:
        for figure, value in row["scores"].items():
            cells = [row["train"], row["trained"], row["test"], row["tested"], figure]
            cells += [f"{value['mean']:.3f}", f"{value['sd']:.3f}"]
            lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("task", choices=["classify", "segment"])
    parser.add_argument("--train", type=named, nargs="+", required=True, metavar="NAME=SOURCE")
    parser.add_argument("--test", type=named, nargs="*", default=[], metavar="NAME=SOURCE")
    parser.add_argument("--out", type=Path, default=Path("learning"))
    parser.add_argument("--steps", type=int, default=3000)
    parser.add_argument("--batch", type=int, default=32)
    parser.add_argument("--seeds", type=int, default=3)
    arguments = parser.parse_args()

    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    torch.backends.cudnn.benchmark = True  # all batches are of one size
    segment = arguments.task == "segment"
    results = {"task": arguments.task, "steps": arguments.steps, "batch": arguments.batch, "rows": []}
    tests = []
    for name, source in arguments.test:
        examples = usable(read(source), arguments.task, False)
        examples = [e for e in examples if e.split == "test"]
        if not examples:
            raise Unreadable(f"'{source}' has no picture for testing that fits; see README.md for what a task needs.")
        tests.append((name, examples) + load(examples, device, segment))
    for name, source in arguments.train:
        every = usable(read(source), arguments.task, True)
        learned = [e for e in every if e.split == "train"]
        held_out = [e for e in every if e.split == "test"]
        if not learned:
            raise Unreadable(f"'{source}' has no picture for training that fits; see README.md for what a task needs.")
        if {e.patient for e in learned} & {e.patient for e in held_out}:
            raise Unreadable(f"'{source}' has patients both in training and in testing; split it by patient.")
        mine = [("held out", held_out) + load(held_out, device, segment)] if held_out else []
        pictures, truth = load(learned, device, segment)
        scores = {test[0]: [] for test in mine + tests}
        for seed in range(arguments.seeds):
            began = time.time()
            network = train(arguments.task, pictures, truth, arguments.steps, arguments.batch, seed)
            for test in mine + tests:
                scores[test[0]].append(score(arguments.task, network, *test[1:], arguments.batch))
            print(f"{name}, seed {seed}: {time.time() - began:.0f} s, {scores}", file=sys.stderr)
        for test in mine + tests:
            results["rows"].append(
                {
                    "train": name,
                    "trained": len(learned),
                    "test": test[0],
                    "tested": len(test[1]),
                    "scores": summary(scores[test[0]]),
                }
            )
    arguments.out.mkdir(parents=True, exist_ok=True)
    (arguments.out / "results.json").write_text(json.dumps(results, indent=1) + "\n")
    (arguments.out / "results.md").write_text(table(results))
    print(table(results))


if __name__ == "__main__":
    try:
        main()
    except Unreadable as error:
        sys.exit(f"learn.py: {error}")
