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


def spheres(draw, count, spread):
    return [[draw.random.gauss(0, spread) * draw.size for _ in range(3)] + [draw.size * draw.log(0.1, 0.7)]
            for _ in range(count)]


def warp(draw):
    return {"amplitude": draw.size * draw.log(1e-3, 0.2), "frequency": draw.log(0.3, 10) / draw.size,
            **draw.some({"octaves": draw.integer(1, 6), "gain": draw.uniform(0, 1),
                         "lacunarity": draw.uniform(1.5, 3)})}


def metaballs(draw, most, depth=0):
    body = {"type": "metaballs", "spheres": spheres(draw, draw.integer(1, most), draw.uniform(0.1, 0.5))}
    if draw.chance(0.5):
        body["kernel"] = draw.choice(["gaussian", "metaball", "soft_object", "wyvill", "cauchy"])
    if draw.chance(0.5):
        body["a"] = body["b"] = draw.uniform(0.5, 4)
    body.update(draw.some({"blend_exponent": draw.uniform(1, 6), "iso_value": draw.log(0.5, 2)}))
    if draw.chance(0.3):
        body["cutoff_radii"] = draw.uniform(1.5, 8)
    if draw.chance(0.3):
        body["subtract"] = spheres(draw, draw.integer(1, 8), 0.4)
    if draw.chance(0.2):
        body["warp"] = warp(draw)
    if draw.chance(0.25 if depth == 0 else 0.1):
        body["operations"] = [operation(draw, depth) for _ in range(draw.integer(1, 3))]
    return body


def operation(draw, depth):
    kind = draw.choice(["union", "intersection", "difference", "blend", "clean_union"])
    fields = {"type": kind, "body": metaballs(draw, 6, depth + 1)}
    if kind == "blend":
        fields.update({"width": draw.size * draw.log(0.01, 0.5), "exponent": draw.uniform(1, 64)})
    elif kind == "clean_union":
        fields.update(draw.some({"bulge": draw.uniform(-0.1, 0.1) * draw.size,
                                 "reach": [draw.size * draw.log(0.02, 0.5) for _ in range(2)]}))
    else:
        fields.update(draw.some({"alpha": draw.uniform(-0.9, 1)}))
    return fields


def fractal(draw):
    kind = draw.choice(["simplex", "perlin", "worley"])
    layer = {"type": kind, "amplitude": draw.height(), "frequency": draw.log(0.3, 100) / draw.size}
    layer.update(draw.some({"octaves": draw.integer(1, 12), "gain": draw.uniform(0, 1.2),
                            "lacunarity": draw.uniform(1.3, 4), "scale": draw.vector(0.2, 3),
                            "bias": [draw.size * c for c in draw.vector(-2, 2)], "weight": draw.uniform(-1.5, 1.5)}))
    if kind == "worley":
        layer.update(draw.some({"distance": draw.choice(["f1", "f2", "f2-f1"])}))
    else:
        layer.update(draw.some({"gradient_modulation": draw.uniform(0, 4)}))
    if draw.chance(0.25):
        layer["warp"] = warp(draw)
    return layer


def spots(draw):
    cell = draw.size * draw.log(0.05, 1)
    layers = draw.integer(1, 12) if draw.chance(0.3) else draw.integer(1, 3)
    layer = {"type": "spots", "amplitude": draw.height(), "cell_size": cell, "size": cell * draw.log(0.05, 0.7),
             "density": draw.log(0.05, 63), "layers": layers}
    layer.update(draw.some({"inverted": draw.chance(0.5), "probability": draw.uniform(0, 1),
                            "even": draw.chance(0.5), "reach": draw.uniform(-0.5, 1),
                            "least_weight": draw.uniform(0, 1), "gaussian": draw.uniform(-2, 2),
                            "alpha": draw.log(0.01, 100), "kappa": draw.uniform(-2, 2),
                            "beta": draw.log(0.1, 100), "gamma": draw.log(0.1, 10),
                            "variances": [draw.log(0.3, 3) for _ in range(3)], "sigma": draw.log(0.5, 6),
                            "lacunarity": draw.uniform(1.2, 3), "gain": draw.uniform(0, 4),
                            "exponent": draw.uniform(0, 2)}))
    if draw.chance(0.3):
        layer["lattice"] = [[1, 0, 0], [draw.uniform(-0.3, 0.3), draw.uniform(0.7, 1.2), 0], [0, 0, 1]]
    if draw.chance(0.3):
        layer["parts"] = [{"center": draw.vector(-0.5, 0.5), "axes": [draw.log(0.2, 1.5) for _ in range(3)],
                           "turn": draw.vector(-180, 180), "weight": draw.uniform(-2, 2)}
                          for _ in range(draw.integer(1, 4))]
    return layer


def sparse(draw):
    return {"type": "sparse", "amplitude": draw.height(), "cell_size": draw.size * draw.log(0.02, 1),
            **draw.some({"levels": draw.integer(1, 16), "probability": draw.uniform(0, 1),
                         "threshold": draw.uniform(0, 1), "gain": draw.uniform(0, 2),
                         "merged": draw.chance(0.5)})}


def random_phase(draw):
    lowest = draw.log(0.2, 20) / draw.size
    return {"type": "random_phase", "height_rms": abs(draw.height()) / 3,
            "cell_size": draw.size * draw.log(0.05, 2), "frequency_min": lowest,
            "frequency_max": lowest * draw.log(1, 20),
            **draw.some({"waves": draw.integer(1, 128), "exponent": draw.uniform(-8, 8),
                         "direction": draw.direction(), "spread": draw.uniform(0, 1),
                         "randomness": draw.uniform(0, 1)})}


def phasor(draw):
    cell = draw.size * draw.log(0.05, 2)
    return {"type": "phasor", "amplitude": draw.height(), "cell_size": cell,
            "frequency": min(draw.log(0.3, 50) / draw.size, 1000 / cell),
            **draw.some({"impulses_per_cell": draw.integer(1, 16), "direction": draw.direction(),
                         "spread": draw.uniform(0, 1),
                         "profile": draw.choice(["sine", "triangle", "sawtooth", "square"])})}


def gabor(draw):
    lobes = [[draw.integer(1, 12) if draw.chance(0.2) else draw.integer(2, 6), draw.uniform(-0.5, 0.5),
              draw.uniform(-0.5, 0.5), draw.log(1e-3, 1)] for _ in range(draw.integer(1, 6))]
    return {"type": "gabor", "pixel_size": draw.size * draw.log(3e-4, 0.1), "height_rms": abs(draw.height()) / 5,
            "lobes": lobes, **draw.some({"impulses_per_kernel": draw.integer(1, 128)})}


def population(draw):
    least = draw.size * draw.log(0.01, 0.1)
    number = {"count": draw.integer(0, 400)} if draw.chance(0.7) else {"density": draw.log(0.1, 30) / draw.size**2}
    return {**number, "least_diameter": least, "greatest_diameter": min(least * draw.log(1, 20), 0.6 * draw.size),
            **draw.some({"exponent": draw.uniform(0.01, 10)})}


def profile(draw):
    return draw.some({"depth": draw.uniform(0, 0.4), "rim_height": draw.uniform(0, 0.2),
                      "extent": draw.uniform(1.05, 5), "flank": draw.uniform(1, 8),
                      "sharpness": draw.log(1, 100), "smoothing": draw.uniform(0, 1),
                      "peak_height": draw.uniform(0, 0.2), "peak_radius": draw.uniform(0.01, 1),
                      "terraces": draw.integer(0, 16)})


def craters(draw):
    layer = {"type": "craters"}
    if draw.chance(0.8):
        layer["population"] = {**population(draw), **draw.some({
            "greatest_age": draw.log(0.1, 10), "depth_spread": draw.uniform(0, 1),
            "degradation": draw.uniform(0, 1)})}
    if draw.chance(0.4) or "population" not in layer:
        layer["craters"] = [{"direction": draw.direction(), "diameter": draw.size * draw.log(0.05, 0.5),
                             **draw.some({"age": draw.uniform(0, 5)})} for _ in range(draw.integer(1, 5))]
    if draw.chance(0.5):
        layer["simple"] = profile(draw)
    if draw.chance(0.4):
        layer["complex_from"] = draw.size * draw.log(0.03, 0.5)
        layer["complex"] = profile(draw)
    return layer


def boulders(draw):
    layer = {"type": "boulders", **draw.some({"smoothing": draw.uniform(0, 1), "roughness": draw.uniform(0, 0.5)})}
    if draw.chance(0.8):
        burials = sorted(draw.uniform(0, 1) for _ in range(2))
        layer["population"] = {**population(draw), **draw.some({
            "axis_ratios": [1] + [draw.uniform(0.05, 1) for _ in range(2)],
            "ratio_spread": draw.uniform(0, 0.9), "greatest_tilt": draw.uniform(0, 90)}),
            "least_burial": burials[0], "greatest_burial": burials[1]}
    else:
        longest = draw.size * draw.log(0.05, 0.4)
        layer["boulders"] = [{"direction": draw.direction(), "axes": [longest * draw.uniform(0.1, 1) for _ in range(3)],
                              **draw.some({"heading": draw.uniform(-360, 360), "tilt": draw.uniform(-180, 180),
                                           "burial": draw.uniform(0, 1)})} for _ in range(draw.integer(1, 5))]
    return layer


MAKERS = [fractal, fractal, spots, sparse, random_phase, phasor, gabor, gabor, craters, boulders]


def use(draw, layer, before, has_group):
    """Ties a layer of noise to a group, to earlier layers by a mask and a join. Returns whether it warps."""
    if has_group and draw.chance(0.3):
        layer["locality"] = {"group": "some", "width": draw.size * draw.log(1e-3, 1)}
    masking = [b["name"] for b in before if b["type"] not in ("craters", "boulders")]
    if masking and draw.chance(0.5):
        border = [draw.height(), draw.height()]
        layer["mask"] = {"layer": draw.choice(masking), "from": border[0], "to": border[1]}
    if not before or draw.chance(0.4):
        return False
    kind = draw.choice(["add", "replace", "blend", "warp", "mask"])
    layer["combine"] = {"type": kind}
    if kind == "blend":
        layer["combine"].update(draw.some({"operator": draw.choice(["union", "intersection"]),
                                           "width": draw.size * draw.log(1e-3, 0.1)}))
    if kind == "warp":
        layer["combine"]["direction"] = draw.direction()
    return kind == "warp"


def recipe(number):
    draw = Draw(number)
    body = metaballs(draw, 30)
    has_group = draw.chance(0.5)
    if has_group:
        members = range(len(body["spheres"]))
        body["groups"] = {"some": sorted(draw.random.sample(members, draw.integer(1, len(members))))}
    layers, warped = [], False
    for name in NAMES_OF_LAYERS[:draw.integer(0, 5)]:
        maker = draw.choice([m for m in MAKERS if not (warped and m is gabor)])
        layer = {**maker(draw), "name": name}
        if draw.chance(0.2):
            layer["seed"] = draw.integer(0, (1 << 30) - 1)
        if maker not in (craters, boulders):
            warped = use(draw, layer, layers, has_group) or warped
        layers.append(layer)
    result = {"format_version": 1, "length_unit": draw.choice(["m", "km"]), "seed": draw.integer(0, 1 << 30),
              "body": body, "layers": layers}
    if draw.chance(0.15):
        result["erosion"] = {"talus_angle": draw.uniform(1, 85), "iterations": draw.integer(1, 2000),
                             **draw.some({"density": draw.log(1, 30000), "rotation_period": draw.log(1, 100)})}
    return result, draw.random.randint(30, 60)
