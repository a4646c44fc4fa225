"""Checkpoints that a test has changed in place, with the checksum and the hash of what they hold now."""

import struct

MASK = (1 << 64) - 1
PIECE = 1 << 20  # [B], of which the checksum adds up one hash each
REALS = 15  # of a particle's row, its velocity from the fourth on


def bit_hash(words, start=14695981039346656037):
    """src/base/bit_hash.hpp"""
    for word in words:
        start = (start ^ word) * 0x9e3779b97f4a7c15 & MASK
        start ^= start >> 32
    return start


def words_of(data):
    return struct.unpack(f"<{(len(data) + 7) // 8}Q", data + bytes(-len(data) % 8))


def sealed(content):
    """The file with its seal (src/output/file_seal.cpp) for what it holds."""
    end = content.rindex(b"\nchecksum ")
    total = 0
    for k, first in enumerate(range(0, end, PIECE)):
        piece = content[first:min(first + PIECE, end)]
        total += bit_hash((k, len(piece), *words_of(piece)))
    return content[:end] + b"\nchecksum %016x\n" % (total & MASK)


def with_velocity(content, row, integers, place, value):
    """One component of a particle's velocity replaced, with the state hash that follows. row: offset of the particle's
    numbers in the file; integers: its id, image and whether it drifts; place: 3, 4 or 5."""
    before = content[row:row + 8 * REALS]
    after = before[:8 * place] + struct.pack("<d", value) + before[8 * place + 8:]
    key, *rest = (number & MASK for number in integers)
    old, new = (bit_hash((key, *words_of(numbers), *rest)) for numbers in (before, after))
    content = content[:row] + after + content[row + 8 * REALS:]
    return content, lambda state_hash: f"{(int(state_hash, 16) - old + new) & MASK:016x}"
