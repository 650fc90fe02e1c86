#!/usr/bin/python3
"""export-feature-net.py FILE: a network for synpo-render features, as ONNX: a ResNet-101 of torchvision without its
last layer.

Needs torch and torchvision (Debian: python3-torch and python3-torchvision).
"""
import argparse
import sys

import torch


def small():
    """Three convolutions, for trying things out; needs torch alone."""
    layers, channels = [], 3
    for width in (32, 64, 128):
        layers += [torch.nn.Conv2d(channels, width, 5, stride=4, padding=2), torch.nn.ReLU()]
        channels = width
    return torch.nn.Sequential(*layers, torch.nn.Conv2d(channels, 2048, 1), torch.nn.ReLU(),
                               torch.nn.AdaptiveAvgPool2d(1), torch.nn.Flatten())


def resnet(weights):
    import torchvision

    if not weights:
        net = torchvision.models.resnet101()
        for module in net.modules():
            # Alike, as fresh ones are, they are stored once and referred to, which OpenCV 4.6 cannot read.
            if isinstance(module, torch.nn.BatchNorm2d):
                torch.nn.init.normal_(module.bias, std=0.1)
            # Else values grow from block to block.
            if isinstance(module, torchvision.models.resnet.Bottleneck):
                torch.nn.init.constant_(module.bn3.weight, 0.25)
    else:
        net = torchvision.models.resnet101(weights=weights)
    net.fc = torch.nn.Identity()
    return net


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", help="where the network goes")
    parser.add_argument("--weights", metavar="NAME",
                        help="torchvision's weights, which it downloads, such as IMAGENET1K_V2 (random ones)")
    parser.add_argument("--seed", type=int, default=1, help="seed of random weights (1)")
    parser.add_argument("--small", action="store_true", help="a small network of random weights in place of ResNet-101")
    args = parser.parse_args()
    if args.small and args.weights:
        parser.error("--small has random weights only")
    torch.manual_seed(args.seed)
    net = (small() if args.small else resnet(args.weights)).eval()
    torch.onnx.export(net, torch.zeros(1, 3, 224, 224), args.file, input_names=["pictures"], output_names=["features"],
                      dynamic_axes={"pictures": {0: "count"}, "features": {0: "count"}}, opset_version=11)


if __name__ == "__main__":
    sys.exit(main())
