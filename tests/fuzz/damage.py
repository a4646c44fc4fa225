"""Damage to an HDF5 file: to its bytes, and to its datasets."""

import h5py
import numpy as np


def flip_bits(data, rng):
    damaged = bytearray(data)
    for _ in range(rng.choice([1, 1, 8, 64])):
        damaged[rng.randrange(len(damaged))] ^= 1 << rng.randrange(8)
    return bytes(damaged)


def cut_off(data, rng):
    return data[:rng.randrange(len(data))]


def zeroed_block(data, rng):
    start = rng.randrange(len(data))
    size = rng.choice([8, 512, 4096])
    return data[:start] + b"\0" * len(data[start:start + size]) + data[start + size:]


def appended(data, rng):
    return data + bytes(rng.randrange(256) for _ in range(rng.choice([1, 1000])))


def no_dataset(file, name, rng):
    del file[name]


def values_of(dataset):
    """An array of one axis at least; texts as bytes, which HDF5 takes back."""
    values = np.atleast_1d(dataset[()])
    return values.astype(bytes) if values.dtype == object else values


def other_length(file, name, rng):
    values = values_of(file[name])
    length = rng.choice([0, 1, max(len(values) - 1, 0), len(values) + 1, 2 * len(values), 100000])
    no_dataset(file, name, rng)
    file[name] = np.resize(values, (length, *values.shape[1:]))


def other_shape(file, name, rng):
    values = values_of(file[name])
    no_dataset(file, name, rng)
    file[name] = rng.choice([values.reshape(-1), values[np.newaxis], values.ravel()[:1].reshape(()), values.T])


def other_number(file, name, rng):
    dataset = file[name]
    if dataset.dtype.kind not in "if" or dataset.size == 0:
        return no_dataset(file, name, rng)
    values = dataset[()].reshape(-1)
    pool = ([-1, 0, 1, 2**31, 2**62, -2**63, 10**9] if values.dtype.kind == "i" else
            [np.nan, np.inf, 0.0, -1.0, 1e300, 5e-324, float(values[0]) * (1 + 1e-12)])
    values[rng.randrange(len(values))] = rng.choice(pool)
    dataset[...] = values.reshape(dataset.shape)


def other_type(file, name, rng):
    kind = rng.choice(["f4", "f8", "i1", "u8", "i8", "S4", "text", "group"])
    shape = file[name].shape
    no_dataset(file, name, rng)
    if kind == "group":
        file.create_group(name)
    elif kind == "text":
        file[name] = "text"
    else:
        file[name] = np.zeros(shape, dtype=kind)


def extra_dataset(file, name, rng):
    file[name + "_more"] = np.zeros(3)


def other_attribute(file, name, rng):
    holder = file if rng.random() < 0.5 else file[name]
    holder.attrs["format"] = rng.choice(["", "scree checkpoint 999", 7, np.zeros(4)])


BYTES = [flip_bits, cut_off, zeroed_block, appended]
DATASETS = [no_dataset, other_length, other_length, other_shape, other_number, other_number, other_type, extra_dataset,
            other_attribute]


def damaged(data, rng):
    """The damaged file and the kind of its damage."""
    if rng.random() < 0.4:
        change = rng.choice(BYTES)
        return change(data, rng), change.__name__
    with h5py.File.in_memory(data) as file:
        names = []
        file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
        change = rng.choice(DATASETS)
        change(file, rng.choice(sorted(names)), rng)
        file.flush()
        return file.id.get_file_image(), change.__name__
