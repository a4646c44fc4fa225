// What contacts remember, as rows of a checkpoint and in the hash of the state: only where a run remembers
// something.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/bit_hash.hpp"
#include "dem/history/kept_contacts.hpp"
#include "dem/particles/particle_fields.hpp"
#include "output/checkpoint.hpp"
#include "partition/ranks.hpp"

namespace scree {

// The rows: of all particles one after the other, per particle the number of its contacts, then per contact
// the partner and the values. The contacts must outlive the checkpoint, and stay the same.
void add_contacts(const KeptContacts& contacts, Checkpoint& out);
// Per contact in the checkpoint; 0 where it has no such rows.
int numbers_in(const Checkpoint& checkpoint);
// Of the particles whose rows this rank has. Throws IoError, on every rank, where the rows do not fit
// together. Collective.
KeptContacts unpack_contacts(const Checkpoint& checkpoint, const Ranks& ranks);

// In the hash of one particle.
void add_contacts(const KeptContacts& contacts, std::size_t particle, BitHash& hash);
// What cannot be one of contacts of these particles, in a deck of so many, in words; empty if nothing.
std::string contacts_trouble(const KeptContacts& contacts, const std::vector<Particle>& particles,
                             std::int64_t of_deck);

}  // namespace scree
