#!/usr/bin/python3
"""thor-dump.py KITCHEN... -o DIR: kitchens of AI2-THOR as scene files for -w kitchen:DIR (synpo-scene(5)).

Needs what pip has as ai2thor, torch and torchvision, and a display or --headless. Layouts of the objects are drawn by
AI2-THOR; what is visible from every pose, with the doors of fridge and microwave open and closed, is what AI2-THOR
says, and each view's features are those of a ResNet-101 trained on ImageNet, in front of its last layer.
"""
import argparse
import hashlib
import json
import math
import os
import struct
import sys

import numpy

GRID_METRES = 0.25
HEADINGS, HORIZONS = (0, 90, 180, 270), (-30, 0, 30)
OBJECTS = ("Container", "Lettuce", "Mug", "Tomato", "Plate", "Apple", "Bowl")
RECEPTACLES = ("Fridge", "Microwave", "Sink")  # the first two have doors
DOORS = 4  # bit 0: the fridge is open, bit 1: the microwave
FEATURES = 2048
BATCH = 32


def say(*words):
    print("thor-dump:", *words, file=sys.stderr)


def write_safetensors(path, metadata, tensors):
    """8 bytes of length, a JSON header, the data; under its name when it is complete."""
    names = {numpy.dtype("<i4"): "I32", numpy.dtype("<f2"): "F16", numpy.dtype("<f4"): "F32"}
    header, at = {"__metadata__": metadata}, 0
    order = sorted(tensors, key=lambda name: (-tensors[name].itemsize, name))
    for name in order:
        tensor = tensors[name]
        header[name] = {"dtype": names[tensor.dtype], "shape": list(tensor.shape),
                        "data_offsets": [at, at + tensor.nbytes]}
        at += tensor.nbytes
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 8)
    with open(path + ".part", "wb") as file:
        file.write(struct.pack("<Q", len(text)) + text)
        for name in order:
            file.write(numpy.ascontiguousarray(tensors[name]).tobytes())
    os.replace(path + ".part", path)


class ResNet:
    """The features in front of the last layer."""

    def __init__(self, weights):
        import torch
        import torchvision

        self.torch = torch
        self.net = torchvision.models.resnet101(weights=weights)
        self.net.fc = torch.nn.Identity()
        self.net.eval()
        digest = hashlib.sha256()
        for name, value in sorted(self.net.state_dict().items()):
            digest.update(name.encode() + value.numpy().tobytes())
        self.name, self.hash = "resnet101-" + weights, digest.hexdigest()[:16]

    def __call__(self, frames):
        """uint8 [n, height, width, 3] to float [n, 2048]."""
        x = (frames / 255.0 - (0.485, 0.456, 0.406)) / (0.229, 0.224, 0.225)
        with self.torch.no_grad():
            return self.net(self.torch.from_numpy(x.transpose(0, 3, 1, 2).astype("f4"))).numpy()


class Rows:
    """Features of frames; equal frames share a row."""

    def __init__(self, extract):
        self.extract, self.known, self.waiting, self.rows = extract, {}, [], []

    def of(self, frame):
        key = hashlib.sha256(frame.tobytes()).digest()
        if key not in self.known:
            self.known[key] = len(self.known)
            self.waiting.append(frame.copy())
            if len(self.waiting) == BATCH:
                self.flush()
        return self.known[key]

    def flush(self):
        if self.waiting:
            self.rows.append(numpy.asarray(self.extract(numpy.stack(self.waiting)), "<f2"))
        self.waiting = []

    def all(self):
        self.flush()
        return numpy.concatenate(self.rows)


class Kitchen:
    """One scene of a controller, on its grid: row 0 is its northernmost, where z is greatest; column 0 its
    westernmost."""

    def __init__(self, controller, name, container):
        self.controller, self.name = controller, name
        self.types = {"Container": container}
        controller.reset(scene=name)
        positions = self.step(action="GetReachablePositions").metadata["actionReturn"]
        self.west = min(p["x"] for p in positions)
        self.north = max(p["z"] for p in positions)
        cells = {self.cell(p): p for p in positions}
        self.poses = [(r, c, heading, horizon) for r, c in sorted(cells) for heading in HEADINGS
                      for horizon in HORIZONS]
        self.positions = [cells[pose[:2]] for pose in self.poses]

    def step(self, **action):
        event = self.controller.step(**action)
        if not event.metadata["lastActionSuccess"]:
            raise RuntimeError("%s: %s fails: %s" % (self.name, action, event.metadata["errorMessage"]))
        return event

    def cell(self, position):
        return round((self.north - position["z"]) / GRID_METRES), round((position["x"] - self.west) / GRID_METRES)

    def next(self):
        """The pose after MoveAhead, RotateLeft, RotateRight, LookUp, LookDown; the same where the move fails."""
        number = {pose: i for i, pose in enumerate(self.poses)}
        rows = []
        for pose in self.poses:
            row, column, heading, horizon = pose
            ahead = {0: (-1, 0), 90: (0, 1), 180: (1, 0), 270: (0, -1)}[heading]
            after = [(row + ahead[0], column + ahead[1], heading, horizon),
                     (row, column, (heading + 270) % 360, horizon),
                     (row, column, (heading + 90) % 360, horizon), (row, column, heading, horizon - 30),
                     (row, column, heading, horizon + 30)]
            rows.append([number.get(to, number[pose]) for to in after])
        return rows

    def spawn(self, seed):
        """Puts the objects somewhere else. The first of each type is the one that tasks mean."""
        self.controller.reset(scene=self.name)
        event = self.step(action="InitialRandomSpawn", randomSeed=seed, forceVisible=False, numPlacementAttempts=5,
                          placeStationary=True)
        things = {o["objectType"]: o for o in reversed(event.metadata["objects"])}
        wanted = [self.types.get(name, name) for name in OBJECTS + RECEPTACLES]
        missing = [name for name in wanted if name not in things]
        if missing:
            raise RuntimeError("%s has no %s" % (self.name, ", ".join(missing)))
        self.ids = [things[name]["objectId"] for name in wanted]
        return [self.cell(things[name]["position"]) for name in wanted[:len(OBJECTS)]]

    def set_doors(self, doors):
        for i in range(2):
            self.step(action="OpenObject" if doors >> i & 1 else "CloseObject", objectId=self.ids[len(OBJECTS) + i],
                      forceAction=True)

    def stand(self, pose):
        p = self.positions[pose]
        return self.step(action="TeleportFull", x=p["x"], y=p["y"], z=p["z"],
                         rotation={"x": 0, "y": self.poses[pose][2], "z": 0},
                         horizon=self.poses[pose][3], standing=True, forceAction=True)

    def distances(self, event):
        """Of objects, then receptacles: horizontal millimetres, -1 where not visible."""
        things, agent = {o["objectId"]: o for o in event.metadata["objects"]}, event.metadata["agent"]["position"]
        return [round(1000 * math.hypot(o["position"]["x"] - agent["x"], o["position"]["z"] - agent["z"]))
                if o["visible"] else -1
                for o in (things[name] for name in self.ids)]

    def views(self, event, rows):
        """The row of the view with each object in the hand, where it is not seen, and with none."""
        usual = rows.of(event.frame)
        views = [usual] * (len(OBJECTS) + 1)
        for i, name in enumerate(self.ids[:len(OBJECTS)]):
            if name in event.instance_detections2D:
                views[i] = rows.of(self.step(action="DisableObject", objectId=name).frame)
                self.step(action="EnableObject", objectId=name)
        return views


def dump(controller, name, layouts, extract, container, progress=say):
    """Metadata and tensors of a scene."""
    kitchen, rows = Kitchen(controller, name, container), Rows(extract)
    objects, distance, view, seed = [], [], [], 0
    while len(objects) < layouts:
        if seed >= 10 * layouts + 10:
            raise RuntimeError("%s: found %d layouts in which everything can be picked up, expected %d"
                               % (name, len(objects), layouts))
        cells = kitchen.spawn(seed)
        seed += 1
        found, seen = [], []
        for doors in range(DOORS):
            kitchen.set_doors(doors)
            for pose in range(len(kitchen.poses)):
                event = kitchen.stand(pose)
                found.append(kitchen.distances(event))
                seen.append(kitchen.views(event, rows))
        nearest = {min((d, i) for i, d in enumerate(near[:len(OBJECTS)]) if d >= 0)[1] for near in found
                   if max(near[:len(OBJECTS)]) >= 0}
        if cells in objects or len(nearest) < len(OBJECTS):
            progress("%s: seed %d passed over: %s"
                     % (name, seed - 1, "as another" if cells in objects else "something cannot be picked up"))
            continue
        objects.append(cells)
        distance.append(found)
        view.append(seen)
        progress("%s: layout %d of %d" % (name, len(objects), layouts))
    poses = len(kitchen.poses)
    distance = numpy.array(distance, "<i4").reshape(layouts, DOORS, poses, -1)
    metadata = {"format": "synpo-scene", "version": "1", "env": name, "rules": "1", "extractor": extract.name,
                "extractor_hash": extract.hash}
    return metadata, {
        "poses": numpy.array(kitchen.poses, "<i4"),
        "starts": numpy.array([i for i, pose in enumerate(kitchen.poses) if pose[3] == 0], "<i4"),
        "next": numpy.array(kitchen.next(), "<i4"),
        "objects": numpy.array(objects, "<i4"),
        "object_distance": distance[..., :len(OBJECTS)],
        "receptacle_distance": distance[..., len(OBJECTS):],
        "view": numpy.array(view, "<i4").reshape(layouts, DOORS, poses, -1),
        "features": rows.all(),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kitchens", nargs="+", metavar="KITCHEN", help="FloorPlan1 to FloorPlan30")
    parser.add_argument("-o", "--output", required=True, metavar="DIR", help="the folder for the scene files")
    parser.add_argument("--layouts", type=int, default=1, metavar="N", help="layouts of the objects in each (1)")
    parser.add_argument("--container", default="Pot", metavar="TYPE",
                        help="AI2-THOR's type that takes the part of Container (Pot)")
    parser.add_argument("--weights", default="IMAGENET1K_V2", metavar="NAME",
                        help="torchvision's weights of ResNet-101 (IMAGENET1K_V2)")
    parser.add_argument("--headless", action="store_true", help="render without a display (CloudRendering)")
    args = parser.parse_args()

    import ai2thor.controller
    more = {}
    if args.headless:
        import ai2thor.platform
        more["platform"] = ai2thor.platform.CloudRendering
    controller = ai2thor.controller.Controller(scene=args.kitchens[0], gridSize=GRID_METRES, snapToGrid=True,
                                               visibilityDistance=1.5, fieldOfView=60,
                                               width=224, height=224, renderInstanceSegmentation=True, **more)
    extract = ResNet(args.weights)
    os.makedirs(args.output, exist_ok=True)
    for name in args.kitchens:
        write_safetensors(os.path.join(args.output, name + ".scene.safetensors"),
                          *dump(controller, name, args.layouts, extract, args.container))


if __name__ == "__main__":
    main()
