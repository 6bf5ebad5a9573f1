"""The networks: DenseNet-121 for views (Huang et al. 2017, as Amadou et al. used), a U-Net for structures."""

import torch
from torch import nn
from torchvision.models import densenet121


def view_network(count):
    """Grey pictures in, logits of `count` views out; nothing is trained before."""
    network = densenet121(weights=None, num_classes=count)
    network.features.conv0 = nn.Conv2d(1, 64, kernel_size=7, stride=2, padding=3, bias=False)
    return network


class _Twice(nn.Sequential):
    def __init__(self, inputs, outputs):
        super().__init__(
            nn.Conv2d(inputs, outputs, 3, padding=1, bias=False),
            nn.InstanceNorm2d(outputs, affine=True),
            nn.LeakyReLU(0.01, inplace=True),
            nn.Conv2d(outputs, outputs, 3, padding=1, bias=False),
            nn.InstanceNorm2d(outputs, affine=True),
            nn.LeakyReLU(0.01, inplace=True),
        )


class UNet(nn.Module):
    """Ronneberger et al. 2015 with nnU-Net's normalization and widths; sides are multiples of 32."""

    def __init__(self, count, widths=(32, 64, 128, 256, 512, 512)):
        super().__init__()
        self.down = nn.ModuleList(_Twice(a, b) for a, b in zip((1,) + widths, widths))
        self.rise = nn.ModuleList(nn.ConvTranspose2d(b, a, 2, stride=2) for a, b in zip(widths, widths[1:]))
        self.up = nn.ModuleList(_Twice(2 * a, a) for a in widths[:-1])
        self.last = nn.Conv2d(widths[0], count, 1)

    def forward(self, x):
        levels = []
        for stage, block in enumerate(self.down):
            x = block(x if stage == 0 else nn.functional.max_pool2d(x, 2))
            levels.append(x)
        for level in reversed(range(len(self.up))):
            x = self.up[level](torch.cat([self.rise[level](x), levels[level]], dim=1))
        return self.last(x)
