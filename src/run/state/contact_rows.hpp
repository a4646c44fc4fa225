// The contact history as rows of a checkpoint and in the state hash; only for contact laws with a history.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/bit_hash.hpp"
#include "dem/history/packed_history.hpp"
#include "dem/particles/particle_fields.hpp"
#include "output/checkpoint.hpp"
#include "partition/ranks.hpp"

namespace scree {

// Adds the rows, in the order of the particles: per particle the number of its contacts, per contact the
// partner and the values. The contacts must outlive the checkpoint and must not change meanwhile.
void add_contacts(const PackedHistory& contacts, Checkpoint& out);
// History content according to the rows of the checkpoint; `kNoHistory` without such rows.
HistoryContent content_in(const Checkpoint& checkpoint);
// The contacts of the particles whose rows this rank has. Throws IoError, on every rank, if the rows are
// inconsistent. Collective.
PackedHistory unpack_contacts(const Checkpoint& checkpoint, const Ranks& ranks);

// Adds the contacts of one particle to its hash.
void add_contacts(const PackedHistory& contacts, std::size_t particle, BitHash& hash);
// Message on the first contact that is not valid for these particles, in a deck with `of_deck` particles;
// empty if all are valid.
std::string contacts_error(const PackedHistory& contacts, const std::vector<Particle>& particles,
                           std::int64_t of_deck);

}  // namespace scree
