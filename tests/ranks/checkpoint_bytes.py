"""Checkpoints that a test has changed in place, with the checksum and the hash of what they hold now."""

import struct

MASK = (1 << 64) - 1
PIECE = 1 << 20  # [B], of which the checksum adds up one hash each


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


def with_velocity(content, particle, x, velocity, new_velocity):
    """The velocity along y of the last particle replaced, with the state hash that follows. Its place along x is x, no
    forces act on it, and it has crossed no side."""
    place = content.rindex(struct.pack("<d", x))
    position = content[place:place + 24]
    at = content.rindex(struct.pack("<d", velocity))

    def hash_of(along_y):
        forces_and_losses, image_and_drifting = 9 * (0,), 4 * (0,)
        motion = (*words_of(position), *words_of(struct.pack("<3d", 0, along_y, 0)))
        return bit_hash((particle, *motion, *forces_and_losses, *image_and_drifting))

    content = content[:at] + struct.pack("<d", new_velocity) + content[at + 8:]
    change = hash_of(new_velocity) - hash_of(velocity)
    return content, lambda state_hash: f"{(int(state_hash, 16) + change) & MASK:016x}"
