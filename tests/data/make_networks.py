#!/usr/bin/env python3
"""Writes the tiny networks of the tests: ONNX files whose answers can be worked out by hand.

    make_networks.py FOLDER

The bytes beside this script are what it writes (`tests/cli/images.py` compares them). ONNX is protobuf
(https://github.com/onnx/onnx, onnx.proto3): only the few fields that such a network needs are encoded.
"""
import os
import struct
import sys

FLOAT = 1  # TensorProto.DataType
INT, INTS = 2, 7  # AttributeProto.AttributeType


def varint(value):
    out = bytearray()
    while value > 127:
        out.append(value & 127 | 128)
        value >>= 7
    return bytes(out + bytearray([value]))


def number(field, value):
    return varint(field << 3) + varint(value)


def data(field, value):
    content = value.encode() if isinstance(value, str) else value
    return varint(field << 3 | 2) + varint(len(content)) + content


def tensor(name, dimensions, values):
    return (b"".join(number(1, d) for d in dimensions) + number(2, FLOAT) + data(8, name) +
            data(9, struct.pack("<%df" % len(values), *values)))


def attribute(name, value):
    if isinstance(value, int):
        return data(1, name) + number(3, value) + number(20, INT)
    return data(1, name) + b"".join(number(8, v) for v in value) + number(20, INTS)


def node(kind, inputs, output, **attributes):
    return (b"".join(data(1, name) for name in inputs) + data(2, output) + data(3, "node_" + output) +
            data(4, kind) + b"".join(data(5, attribute(k, v)) for k, v in attributes.items()))


def value(name, dimensions):
    """A float tensor; a dimension may be a name: any size."""
    shape = b"".join(data(1, data(2, d) if isinstance(d, str) else number(1, d)) for d in dimensions)
    return data(1, name) + data(2, data(1, number(1, FLOAT) + data(2, shape)))


def model(inputs, nodes, weights, outputs):
    graph = (b"".join(data(1, n) for n in nodes) + data(2, "tiny") + b"".join(data(5, w) for w in weights) +
             b"".join(data(11, i) for i in inputs) + b"".join(data(12, o) for o in outputs))
    return number(1, 7) + data(7, graph) + data(8, data(1, "") + number(2, 11))


def two_layers():
    """Two maps, the first of which the second is made from: first = relu(A rgb + a) at every pixel,
    second = relu(B first) at every second pixel, both ways. A = (2 0 0; 0 1 -1), a = (0, 0.5),
    B = (1 0; 1 1; 0 -1)."""
    return model(
        [value("image", [1, 3, "height", "width"])],
        [node("Conv", ["image", "A", "a"], "sum1", kernel_shape=[1, 1]),
         node("Relu", ["sum1"], "first"),
         node("Conv", ["first", "B"], "sum2", kernel_shape=[1, 1], strides=[2, 2]),
         node("Relu", ["sum2"], "second")],
        [tensor("A", [2, 3, 1, 1], [2, 0, 0, 0, 1, -1]), tensor("a", [2], [0, 0.5]),
         tensor("B", [3, 2, 1, 1], [1, 0, 1, 1, 0, -1])],
        [value("first", [1, 2, "height", "width"]), value("second", [1, 3, "height2", "width2"])])


def mean_colour(size):
    """An image's mean red, green and blue: an embedding of three dimensions."""
    return model([value("image", [1, 3, size, size])],
                 [node("GlobalAveragePool", ["image"], "means"), node("Flatten", ["means"], "embedding", axis=1)],
                 [], [value("embedding", [1, 3])])


def pixels():
    """Every number of a picture of 4 x 4 pixels: 48 dimensions."""
    return model([value("image", [1, 3, 4, 4])], [node("Flatten", ["image"], "numbers", axis=1)], [],
                 [value("numbers", [1, 48])])


NETWORKS = {"two_layers.onnx": two_layers(), "mean_colour.onnx": mean_colour(4), "pixels.onnx": pixels()}


def main():
    if len(sys.argv) != 2:
        sys.exit("usage: make_networks.py FOLDER")
    for name, content in NETWORKS.items():
        with open(os.path.join(sys.argv[1], name), "wb") as file:
            file.write(content)


if __name__ == "__main__":
    main()
