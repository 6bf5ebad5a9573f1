"""What makes a training picture another one, on the device: how it lies, how it is displayed, what gets lost."""

import torch
from torch.nn import functional


def _uniform(count, low, high, device):
    return torch.empty(count, 1, 1, 1, device=device).uniform_(low, high)


def lay_anew(pictures, masks=None):
    """Turned by up to 15 degrees, 0.75 to 1.25 times as large and 10 % stretched, moved by up to a tenth; half of them
    mirrored, since scanners put the marker on either side."""
    count, device = len(pictures), pictures.device
    angle = torch.empty(count, device=device).uniform_(-0.26, 0.26)
    size = torch.empty(count, device=device).uniform_(0.75, 1.25)
    stretch = torch.empty(count, device=device).uniform_(0.95, 1.05)
    mirror = torch.randint(0, 2, (count,), device=device) * 2.0 - 1.0
    move = torch.empty(count, 2, device=device).uniform_(-0.2, 0.2)
    cos, sin = torch.cos(angle), torch.sin(angle)
    across, along = mirror / (size * stretch), 1.0 / size
    rows = [cos * across, -sin * along, move[:, 0], sin * across, cos * along, move[:, 1]]
    grid = functional.affine_grid(torch.stack(rows, 1).view(count, 2, 3), list(pictures.shape), align_corners=False)
    pictures = functional.grid_sample(pictures, grid, mode="bilinear", align_corners=False)
    if masks is None:
        return pictures, None
    moved = functional.grid_sample(masks[:, None].float(), grid, mode="nearest", align_corners=False)
    return pictures, moved[:, 0].long()


def _smooth_field(count, side, device, coarse):
    field = torch.randn(count, 1, coarse, coarse, device=device)
    return functional.interpolate(field, size=(side, side), mode="bicubic", align_corners=False)


def _blur(pictures, sigma):
    radius = 4
    x = torch.arange(-radius, radius + 1, device=pictures.device, dtype=pictures.dtype)
    kernel = torch.exp(-0.5 * (x / sigma) ** 2)
    kernel = (kernel / kernel.sum()).view(1, 1, 1, -1)
    pictures = functional.conv2d(pictures, kernel, padding=(0, radius))
    return functional.conv2d(pictures, kernel.transpose(2, 3), padding=(radius, 0))


def show_anew(pictures):
    """Other grey maps, gains and shading, speckle and smoothing, drop-outs; grey levels 0 to 1 in and out. What is
    black outside the fan stays black."""
    count, side, device = len(pictures), pictures.shape[-1], pictures.device
    fan = (pictures > 0).float()
    pictures = pictures.clamp(1e-3, 1.0) ** _uniform(count, 0.5, 1.8, device)
    pictures = pictures * torch.exp(0.25 * _smooth_field(count, side, device, 4))
    pictures = pictures * torch.exp(_uniform(count, 0.0, 0.4, device) * torch.randn_like(pictures))
    lost = torch.sigmoid(4.0 * (_smooth_field(count, side, device, 6) - 1.5))
    pictures = pictures * (1.0 - _uniform(count, 0.0, 0.9, device) * lost)
    if torch.rand(()) < 0.5:
        pictures = _blur(pictures, float(torch.empty(()).uniform_(0.5, 2.0)))
    haze = _uniform(count, 0.0, 0.2, device)
    pictures = haze + (1.0 - haze) * pictures * _uniform(count, 0.7, 1.3, device)
    return (pictures * fan).clamp(0.0, 1.0)
