"""Draws random valid recipes.

A recipe has any body (kernels, subtractive metaballs, warp, operations), up to five layers of any type with
masks, joins and localities, and sometimes erosion. Most values are drawn from the whole of their ranges, extremes
included. Recipe number N depends on N alone.
"""
import math
import random

NAMES_OF_LAYERS = ["a", "b", "c", "d", "e"]


class Draw:
    """Random values of one recipe. `size` is the body's approximate radius, length units."""

    def __init__(self, number):
        self.random = random.Random(f"recipe {number}")
        self.size = self.log(1e-2, 1e2)

    def chance(self, probability):
        return self.random.random() < probability

    def uniform(self, low, high):
        """Uniform; one value in twelve is an end of the range."""
        if self.chance(1 / 12):
            return self.random.choice([low, high])
        return self.random.uniform(low, high)

    def log(self, low, high):
        return math.exp(self.random.uniform(math.log(low), math.log(high)))

    def integer(self, low, high):
        return self.random.choice([low, high]) if self.chance(1 / 12) else self.random.randint(low, high)

    def choice(self, values):
        return self.random.choice(values)

    def vector(self, low, high):
        return [self.uniform(low, high) for _ in range(3)]

    def direction(self):
        while True:
            vector = [self.random.gauss(0, 1) for _ in range(3)]
            if sum(c * c for c in vector) > 1e-6:
                return vector

    def height(self):
        """A height of noise with either sign, mostly small beside the body."""
        return self.choice([-1, 1]) * self.size * self.log(1e-4, 0.3)

    def some(self, fields):
        """Keeps each field with a chance of one half; the others take their defaults."""
        return {name: value for name, value in fields.items() if self.chance(0.5)}

    def spheres(self, count, spread):
        return [[self.random.gauss(0, spread) * self.size for _ in range(3)] + [self.size * self.log(0.1, 0.7)]
                for _ in range(count)]

    def warp(self):
        return {"amplitude": self.size * self.log(1e-3, 0.2), "frequency": self.log(0.3, 10) / self.size,
                **self.some({"octaves": self.integer(1, 6), "gain": self.uniform(0, 1),
                             "lacunarity": self.uniform(1.5, 3)})}

    def metaballs(self, most, depth=0):
        body = {"type": "metaballs", "spheres": self.spheres(self.integer(1, most), self.uniform(0.1, 0.5))}
        if self.chance(0.5):
            body["kernel"] = self.choice(["gaussian", "metaball", "soft_object", "wyvill", "cauchy"])
        if self.chance(0.5):
            body["a"] = body["b"] = self.uniform(0.5, 4)
        body.update(self.some({"blend_exponent": self.uniform(1, 6), "iso_value": self.log(0.5, 2)}))
        if self.chance(0.3):
            body["cutoff_radii"] = self.uniform(1.5, 8)
        if self.chance(0.3):
            body["subtract"] = self.spheres(self.integer(1, 8), 0.4)
        if self.chance(0.2):
            body["warp"] = self.warp()
        if self.chance(0.25 if depth == 0 else 0.1):
            body["operations"] = [self.operation(depth) for _ in range(self.integer(1, 3))]
        return body

    def operation(self, depth):
        kind = self.choice(["union", "intersection", "difference", "blend", "clean_union"])
        fields = {"type": kind, "body": self.metaballs(6, depth + 1)}
        if kind == "blend":
            fields.update({"width": self.size * self.log(0.01, 0.5), "exponent": self.uniform(1, 64)})
        elif kind == "clean_union":
            fields.update(self.some({"bulge": self.uniform(-0.1, 0.1) * self.size,
                                     "reach": [self.size * self.log(0.02, 0.5) for _ in range(2)]}))
        else:
            fields.update(self.some({"alpha": self.uniform(-0.9, 1)}))
        return fields

    def fractal(self):
        kind = self.choice(["simplex", "perlin", "worley"])
        layer = {"type": kind, "amplitude": self.height(), "frequency": self.log(0.3, 100) / self.size}
        layer.update(self.some({"octaves": self.integer(1, 12), "gain": self.uniform(0, 1.2),
                                "lacunarity": self.uniform(1.3, 4), "scale": self.vector(0.2, 3),
                                "bias": [self.size * c for c in self.vector(-2, 2)], "weight": self.uniform(-1.5, 1.5)}))
        if kind == "worley":
            layer.update(self.some({"distance": self.choice(["f1", "f2", "f2-f1", "blocks"])}))
        else:
            layer.update(self.some({"gradient_modulation": self.uniform(0, 4)}))
        if self.chance(0.25):
            layer["warp"] = self.warp()
        return layer

    def spots(self):
        cell = self.size * self.log(0.05, 1)
        layers = self.integer(1, 12) if self.chance(0.3) else self.integer(1, 3)
        layer = {"type": "spots", "amplitude": self.height(), "cell_size": cell, "size": cell * self.log(0.05, 0.7),
                 "density": self.log(0.05, 63), "layers": layers}
        layer.update(self.some({"inverted": self.chance(0.5), "probability": self.uniform(0, 1),
                                "even": self.chance(0.5), "reach": self.uniform(-0.5, 1),
                                "least_weight": self.uniform(0, 1), "gaussian": self.uniform(-2, 2),
                                "alpha": self.log(0.01, 100), "kappa": self.uniform(-2, 2),
                                "beta": self.log(0.1, 100), "gamma": self.log(0.1, 10),
                                "variances": [self.log(0.3, 3) for _ in range(3)], "sigma": self.log(0.5, 6),
                                "lacunarity": self.uniform(1.2, 3), "gain": self.uniform(0, 4),
                                "exponent": self.uniform(0, 2)}))
        if self.chance(0.3):
            layer["lattice"] = [[1, 0, 0], [self.uniform(-0.3, 0.3), self.uniform(0.7, 1.2), 0], [0, 0, 1]]
        if self.chance(0.3):
            layer["parts"] = [{"center": self.vector(-0.5, 0.5), "axes": [self.log(0.2, 1.5) for _ in range(3)],
                               "turn": self.vector(-180, 180), "weight": self.uniform(-2, 2)}
                              for _ in range(self.integer(1, 4))]
        return layer

    def sparse(self):
        return {"type": "sparse", "amplitude": self.height(), "cell_size": self.size * self.log(0.02, 1),
                **self.some({"levels": self.integer(1, 16), "probability": self.uniform(0, 1),
                             "threshold": self.uniform(0, 1), "gain": self.uniform(0, 2), "merged": self.chance(0.5)})}

    def random_phase(self):
        lowest = self.log(0.2, 20) / self.size
        return {"type": "random_phase", "height_rms": abs(self.height()) / 3,
                "cell_size": self.size * self.log(0.05, 2), "frequency_min": lowest,
                "frequency_max": lowest * self.log(1, 20),
                **self.some({"waves": self.integer(1, 128), "exponent": self.uniform(-8, 8),
                             "direction": self.direction(), "spread": self.uniform(0, 1),
                             "randomness": self.uniform(0, 1)})}

    def phasor(self):
        cell = self.size * self.log(0.05, 2)
        return {"type": "phasor", "amplitude": self.height(), "cell_size": cell,
                "frequency": min(self.log(0.3, 50) / self.size, 1000 / cell),
                **self.some({"impulses_per_cell": self.integer(1, 16), "direction": self.direction(),
                             "spread": self.uniform(0, 1),
                             "profile": self.choice(["sine", "triangle", "sawtooth", "square"])})}

    def gabor(self):
        lobes = [[self.integer(1, 12) if self.chance(0.2) else self.integer(2, 6), self.uniform(-0.5, 0.5),
                  self.uniform(-0.5, 0.5), self.log(1e-3, 1)] for _ in range(self.integer(1, 6))]
        return {"type": "gabor", "pixel_size": self.size * self.log(3e-4, 0.1), "height_rms": abs(self.height()) / 5,
                "lobes": lobes, **self.some({"impulses_per_kernel": self.integer(1, 128)})}

    def population(self):
        least = self.size * self.log(0.01, 0.1)
        number = {"count": self.integer(0, 400)} if self.chance(0.7) else {"density": self.log(0.1, 30) / self.size**2}
        return {**number, "least_diameter": least, "greatest_diameter": min(least * self.log(1, 20), 0.6 * self.size),
                **self.some({"exponent": self.uniform(0.01, 10)})}

    def profile(self):
        return self.some({"depth": self.uniform(0, 0.4), "rim_height": self.uniform(0, 0.2),
                          "extent": self.uniform(1.05, 5), "flank": self.uniform(1, 8), "sharpness": self.log(1, 100),
                          "smoothing": self.uniform(0, 1), "peak_height": self.uniform(0, 0.2),
                          "peak_radius": self.uniform(0.01, 1), "terraces": self.integer(0, 16)})

    def craters(self):
        layer = {"type": "craters"}
        if self.chance(0.8):
            layer["population"] = {**self.population(), **self.some({
                "greatest_age": self.log(0.1, 10), "depth_spread": self.uniform(0, 1),
                "degradation": self.uniform(0, 1)})}
        if self.chance(0.4) or "population" not in layer:
            layer["craters"] = [{"direction": self.direction(), "diameter": self.size * self.log(0.05, 0.5),
                                 **self.some({"age": self.uniform(0, 5)})} for _ in range(self.integer(1, 5))]
        if self.chance(0.5):
            layer["simple"] = self.profile()
        if self.chance(0.4):
            layer["complex_from"] = self.size * self.log(0.03, 0.5)
            layer["complex"] = self.profile()
        return layer

    def boulders(self):
        layer = {"type": "boulders", **self.some({"smoothing": self.uniform(0, 1), "roughness": self.uniform(0, 0.5)})}
        if self.chance(0.8):
            burials = sorted(self.uniform(0, 1) for _ in range(2))
            layer["population"] = {**self.population(), **self.some({
                "axis_ratios": [1] + [self.uniform(0.05, 1) for _ in range(2)],
                "ratio_spread": self.uniform(0, 0.9), "greatest_tilt": self.uniform(0, 90)}),
                "least_burial": burials[0], "greatest_burial": burials[1]}
        else:
            longest = self.size * self.log(0.05, 0.4)
            layer["boulders"] = [{"direction": self.direction(), "axes": [longest * self.uniform(0.1, 1) for _ in range(3)],
                                  **self.some({"heading": self.uniform(-360, 360), "tilt": self.uniform(-180, 180),
                                               "burial": self.uniform(0, 1)})} for _ in range(self.integer(1, 5))]
        return layer

    def use(self, layer, before, has_group):
        """Ties a layer of noise to a group, to earlier layers by a mask and a join. Returns whether it warps."""
        if has_group and self.chance(0.3):
            layer["locality"] = {"group": "some", "width": self.size * self.log(1e-3, 1)}
        masking = [b["name"] for b in before if b["type"] not in ("craters", "boulders")]
        if masking and self.chance(0.5):
            border = [self.height(), self.height()]
            layer["mask"] = {"layer": self.choice(masking), "from": border[0], "to": border[1]}
        if not before or self.chance(0.4):
            return False
        kind = self.choice(["add", "replace", "blend", "warp", "mask"])
        layer["combine"] = {"type": kind}
        if kind == "blend":
            layer["combine"].update(self.some({"operator": self.choice(["union", "intersection"]),
                                               "width": self.size * self.log(1e-3, 0.1)}))
        if kind == "warp":
            layer["combine"]["direction"] = self.direction()
        return kind == "warp"


MAKERS = [Draw.fractal, Draw.fractal, Draw.spots, Draw.sparse, Draw.random_phase, Draw.phasor, Draw.gabor, Draw.gabor, Draw.craters, Draw.boulders]


def recipe(number):
    draw = Draw(number)
    body = draw.metaballs(30)
    has_group = draw.chance(0.5)
    if has_group:
        members = range(len(body["spheres"]))
        body["groups"] = {"some": sorted(draw.random.sample(members, draw.integer(1, len(members))))}
    layers, warped = [], False
    for name in NAMES_OF_LAYERS[:draw.integer(0, 5)]:
        maker = draw.choice([m for m in MAKERS if not (warped and m is Draw.gabor)])
        layer = {**maker(draw), "name": name}
        if draw.chance(0.2):
            layer["seed"] = draw.integer(0, (1 << 30) - 1)
        if maker not in (Draw.craters, Draw.boulders):
            warped = draw.use(layer, layers, has_group) or warped
        layers.append(layer)
    result = {"format_version": 1, "length_unit": draw.choice(["m", "km"]), "seed": draw.integer(0, 1 << 30),
              "body": body, "layers": layers}
    if draw.chance(0.15):
        result["erosion"] = {"talus_angle": draw.uniform(1, 85), "iterations": draw.integer(1, 2000),
                             **draw.some({"density": draw.log(1, 30000), "rotation_period": draw.log(1, 100)})}
    return result, draw.random.randint(30, 60)
