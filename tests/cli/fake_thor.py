"""fake_thor.py DIR KITCHEN LAYOUTS: a scene file by scripts/thor-dump.py from a controller that answers as AI2-THOR's
does, without Unity.

A room of 6 x 6 cells with everything around it; the first object of the list lies in the fridge.
"""
import importlib.util
import math
import os
import random
import sys
import types

import numpy

SIDE = 6
spec = importlib.util.spec_from_file_location("thor_dump",
                                              os.path.join(os.path.dirname(__file__), "../../scripts/thor-dump.py"))
thor = importlib.util.module_from_spec(spec)
spec.loader.exec_module(thor)


class Controller:
    def __init__(self):
        self.agent, self.heading, self.horizon, self.open, self.disabled = (0.0, 0.0), 0, 0, set(), set()

    def reset(self, scene):
        self.scene, self.places, self.open, self.disabled = scene, {}, set(), set()
        self.spawn(0)
        return self.event()

    def spawn(self, seed):
        draw = random.Random("%s %s" % (self.scene, seed))
        around = ([(-1, i) for i in range(SIDE)] + [(SIDE, i) for i in range(SIDE)]
                  + [(i, -1) for i in range(SIDE)] + [(i, SIDE) for i in range(SIDE)])
        draw.shuffle(around)
        kinds = [{"Container": "Pot"}.get(name, name) for name in thor.OBJECTS + thor.RECEPTACLES]
        self.places = dict(zip(kinds, around))
        self.places["Pot"] = self.places["Fridge"]

    def visible(self, kind):
        if kind in self.disabled or (kind == "Pot" and "Fridge" not in self.open):
            return False
        x, z = (0.25 * v for v in self.places[kind])
        dx, dz = x - self.agent[0], z - self.agent[1]
        angle = math.degrees(math.atan2(dx, dz)) - self.heading
        return math.hypot(dx, dz) <= 1.5 and abs((angle + 180) % 360 - 180) <= 30 and self.horizon >= 0

    def step(self, action, **a):
        kind = a["objectId"].split("|")[0] if "objectId" in a else None
        result = None
        if action == "GetReachablePositions":
            result = [{"x": 0.25 * x, "y": 0.9, "z": 0.25 * z} for x in range(SIDE) for z in range(SIDE)]
        elif action == "InitialRandomSpawn":
            self.spawn(a["randomSeed"])
        elif action == "TeleportFull":
            self.agent, self.heading, self.horizon = (a["x"], a["z"]), a["rotation"]["y"], a["horizon"]
        elif action == "OpenObject":
            self.open.add(kind)
        elif action == "CloseObject":
            self.open.discard(kind)
        elif action == "DisableObject":
            self.disabled.add(kind)
        elif action == "EnableObject":
            self.disabled.remove(kind)
        else:
            raise ValueError(action)
        return self.event(result)

    def event(self, result=None):
        objects = [{"objectId": kind + "|0", "objectType": kind, "position": {"x": 0.25 * x, "y": 1, "z": 0.25 * z},
                    "visible": self.visible(kind)}
                   for kind, (x, z) in self.places.items()]
        frame = numpy.zeros((2, 6, 3), "u1")
        numbers = [self.heading // 90, self.horizon // 30 + 1, len(self.open)] + [int(o["visible"]) for o in objects]
        frame.flat[:len(numbers)] = numbers
        metadata = {"lastActionSuccess": True, "errorMessage": "", "actionReturn": result, "objects": objects,
                    "agent": {"position": {"x": self.agent[0], "y": 0.9, "z": self.agent[1]}}}
        return types.SimpleNamespace(metadata=metadata, frame=frame,
                                     instance_detections2D={o["objectId"]: None for o in objects if o["visible"]})


class Extract:
    name, hash = "frames", os.environ.get("EXTRACTOR_HASH", "0123456789abcdef")

    def __call__(self, frames):
        return numpy.tile(frames.reshape(len(frames), -1) / 4.0, 2048 // 36 + 1)[:, :2048]


folder, name, layouts = sys.argv[1], sys.argv[2], int(sys.argv[3])
thor.write_safetensors(os.path.join(folder, name + ".scene.safetensors"),
                       *thor.dump(Controller(), name, layouts, Extract(), "Pot", progress=lambda *words: None))
