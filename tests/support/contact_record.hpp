// Contact histories by brute force, maintained beside a run from the positions of its particles and bodies
// after each step.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "dem/contact/contact_walk.hpp"
#include "dem/history/contact_key.hpp"
#include "dem/history/packed_history.hpp"
#include "dem/particles/particle_store.hpp"
#include "dem/surfaces/surfaces.hpp"
#include "support/bits.hpp"
#include "support/history_test_law.hpp"

namespace scree {

template <int kNumbers>
class ContactRecord {
 public:
  using Law = HistoryTestLaw<kNumbers>;
  using History = typename Law::History;

  explicit ContactRecord(const Model& model)
      : model_(model), subdomain_(model.space), planes_(wall_planes(model)) {}

  // Takes the result of a step. records: of all particles, in the order of their ids.
  void add_step(const std::vector<Particle>& records, const std::vector<BodyMotion>& motion) {
    now_.clear();
    for (const Particle& p : records) {
      if (p.drifting) continue;
      for (const Particle& q : records)
        if (!q.drifting) add_particle(p, q);
      for (std::size_t w = 0; w < planes_.size(); ++w)
        add(p, surface_id(static_cast<Index>(w)), kZeroShift, {}, wall_pair(place(p), planes_[w]));
      add_bodies(p, motion);
    }
    for (const auto& [name, history] : before_)
      if (!now_.count(name)) ++ended_;
    std::swap(before_, now_);
  }

  // The contacts of these particles; all others are dropped.
  PackedHistory contacts(const std::vector<Particle>& records) {
    PackedHistory out;
    out.content = HistoryContent::of_law(kNumbers);
    std::map<Name, Entry> left;
    std::set<GlobalId> here;
    for (const Particle& p : records)
      if (!p.drifting) here.insert(p.global_id);
    for (const Particle& p : records) {
      for (auto at = before_.lower_bound({p.global_id, 0, {}}); at != before_.end(); ++at) {
        const auto& [id, partner, image] = at->first;
        if (id != p.global_id) break;
        if (here.count(id) == 0 || (partner < kFirstSurfaceId && here.count(partner) == 0)) continue;
        std::array<Real, kNumbers> numbers;
        Law::write_history(at->second.history,
                           [&](int k, Real value) { numbers[static_cast<std::size_t>(k)] = value; });
        out.add(at->second.key, numbers);
        left.insert(*at);
      }
      out.end_row();
    }
    before_ = left;
    return out;
  }

  // Number of contacts that have ended so far, and of those seen with another image than at their start.
  int ended() const { return ended_; }
  int moved_on() const { return moved_on_; }

 private:
  // Particle, partner, and how many periods apart they are, both unwrapped: constant during the contact.
  using Name = std::tuple<GlobalId, GlobalId, std::array<int, 3>>;
  struct Entry {
    std::int64_t key;  // with the image that both have in the periodic box
    History history;
  };

  static Vec4 place(const Particle& p) { return vec4(p.position, p.radius); }

  void add_particle(const Particle& p, const Particle& q) {
    for_each_shift(subdomain_.period(), [&](Vec3 shift, std::int8_t image) {
      if (p.global_id == q.global_id && image == kZeroShift) return;
      const Vec3 r = p.position - (q.position + shift);
      add(p, q.global_id, image, q.image, sphere_pair(r, p.radius + q.radius));
    });
  }

  void add_bodies(const Particle& p, const std::vector<BodyMotion>& motion) {
    GlobalId surface = surface_id(static_cast<Index>(planes_.size()));
    for (std::size_t b = 0; b < motion.size(); ++b)
      for (const Shape& shape : model_.bodies[b].shapes) {
        ImageCount image;
        const Vec3 at = subdomain_.wrap(
            snap(point_motion(motion[b], shape.offset).position, subdomain_.snap_constant()), image);
        for_each_shift(subdomain_.period(), [&](Vec3 shift, std::int8_t number) {
          add(p, surface, number, image, sphere_pair(p.position - (at + shift), p.radius + shape.radius));
        });
        ++surface;
      }
  }

  void add(const Particle& p, GlobalId partner, std::int8_t image, ImageCount q,
           const ContactGeometry& pair) {
    if (!(pair.overlap > 0)) return;
    const bool wall = partner >= kFirstSurfaceId && partner < surface_id(static_cast<Index>(planes_.size()));
    const std::array<int, 3> periods = {image % 3 - 1 + p.image.x - q.x, image / 3 % 3 - 1 + p.image.y - q.y,
                                        image / 9 - 1 + p.image.z - q.z};
    const Name name{p.global_id, partner, wall ? std::array<int, 3>{} : periods};
    Entry entry{row_key(partner, image), {}};
    if (const auto old = before_.find(name); old != before_.end()) {
      entry.history = old->second.history;
      moved_on_ += entry.key != old->second.key;
    }
    Law::remember(pair.along(pair.overlap), entry.history);
    now_[name] = entry;
  }

  const Model& model_;
  Subdomain subdomain_;
  std::vector<WallPlane> planes_;
  std::map<Name, Entry> before_, now_;
  int ended_ = 0, moved_on_ = 0;
};

// The first difference of a bit between the two; "" if there is none.
inline std::string difference(const PackedHistory& a, const PackedHistory& b) {
  if (a.content != b.content || a.offsets != b.offsets)
    return "numbers of contacts: " + std::to_string(a.keys.size()) + " and " + std::to_string(b.keys.size());
  for (std::int64_t i = 0; i < a.particles(); ++i)
    for (std::int64_t k = a.offsets[static_cast<std::size_t>(i)];
         k < a.offsets[static_cast<std::size_t>(i) + 1]; ++k) {
      if (a.keys[static_cast<std::size_t>(k)] != b.keys[static_cast<std::size_t>(k)])
        return "keys of particle " + std::to_string(i);
      if (!same_bits(a.values_of(k), b.values_of(k))) return "values of particle " + std::to_string(i);
    }
  return "";
}

// Contacts between particles whose two sides are not mirrored bit for bit; ids: of all particles, in the
// order of the rows. kEven to kLastEven: the numbers that do not change their signs.
template <int kNumbers, int kEven = 3, int kLastEven = kEven>
int unmirrored(const std::vector<Particle>& particles, const PackedHistory& contacts) {
  std::map<std::tuple<GlobalId, GlobalId, int>, std::span<const Real>> sides;
  for (std::int64_t i = 0; i < contacts.particles(); ++i)
    for (std::int64_t k = contacts.offsets[static_cast<std::size_t>(i)];
         k < contacts.offsets[static_cast<std::size_t>(i) + 1]; ++k) {
      const std::int64_t key = contacts.keys[static_cast<std::size_t>(k)];
      sides[{particles[static_cast<std::size_t>(i)].global_id, id_of(key), image_of(key)}] =
          contacts.values_of(k);
    }
  int count = 0;
  for (const auto& [name, own] : sides) {
    const auto& [id, partner, image] = name;
    if (partner >= kFirstSurfaceId) continue;
    const auto other = sides.find({partner, id, 26 - image});
    bool mirrored = other != sides.end();
    for (std::size_t k = 0; mirrored && k < kNumbers; ++k)
      mirrored = own[k] == (k >= kEven && k <= kLastEven ? other->second[k] : -other->second[k]);
    count += !mirrored;
  }
  return count;
}

}  // namespace scree
