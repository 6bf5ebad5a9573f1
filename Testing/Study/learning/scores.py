"""What a network's guesses are worth."""

import numpy


def dice(found, truth, structure, counts):
    """Mean Dice over the pictures whose `counts` is true; where a structure is in neither mask, it is 1. None: no such
    picture."""
    values = []
    for guess, mask, counted in zip(found, truth, counts):
        if counted:
            a, b = guess == structure, mask == structure
            size = int(a.sum()) + int(b.sum())
            values.append(2.0 * int((a & b).sum()) / size if size else 1.0)
    return float(numpy.mean(values)) if values else None


def macro_f1(found, truth, classes):
    """F1 of each class that is in `truth`, their mean, and the share that is right."""
    values = []
    for c in range(classes):
        if (truth == c).any():
            hits = int(((found == c) & (truth == c)).sum())
            values.append(2.0 * hits / (int((found == c).sum()) + int((truth == c).sum())))
    return {"F1": float(numpy.mean(values)), "accuracy": float((found == truth).mean())}
