// Numbers of tests and benchmarks for documents, with their bounds. Where the environment variable
// SCREE_MEASURED names a folder, the program writes them there at its end, a row per key in a file named
// after its command line, for tests/support/measured.py. Otherwise they are dropped.
#pragma once

#include <cmath>
#include <limits>
#include <ostream>
#include <string>

#include "support/bars.hpp"
#include "support/near.hpp"

namespace scree {

// A number and its bounds, which it may reach; NaN is within none.
struct Bounded {
  Real value;
  Real at_least = -std::numeric_limits<Real>::infinity();
  Real at_most = std::numeric_limits<Real>::infinity();

  explicit operator bool() const { return value >= at_least && value <= at_most; }
};

inline std::ostream& operator<<(std::ostream& out, const Bounded& number) {
  return out << number.value << ", allowed: " << number.at_least << " to " << number.at_most;
}

inline Bounded at_most(Real error, Real bound) { return {.value = std::abs(error), .at_most = bound}; }
inline Bounded at_least(Real value, Real bound) { return {.value = value, .at_least = bound}; }
inline Bounded in_range(Real value, Real least, Real most) { return {value, least, most}; }

// True where nothing differs, by the names of the differing parts.
struct BitForBit {
  std::string differing;
  explicit operator bool() const { return differing.empty(); }
};

inline std::ostream& operator<<(std::ostream& out, const BitForBit& bits) {
  return out << "differing: " << bits.differing;
}

inline Bounded bounded(const Bounded& number) { return number; }
inline Bounded bounded(const Kept& kept) { return at_most(kept.error, kept.bars.promise); }
// In the unit of the values where an absolute bound is given, otherwise relative to the expected one.
template <class Value>
Bounded bounded(const Nearness<Value>& near) {
  if (near.within.absolute > 0) return at_most(near.difference, near.within.absolute);
  return at_most(near.difference / near.magnitude, near.within.relative);
}
inline Bounded bounded(const BitForBit& bits) { return at_most(bits ? 0 : 1, 0); }

// Records a number under a key, e.g. "valley/rise", with its unit; of all values under one key, the least
// and the largest. Of a composed key the source contains the beginning, at least up to the slash.
void note(const std::string& key, const std::string& unit, const Bounded& number);
// Records a value without bounds.
inline void note(const std::string& key, const std::string& unit, Real value) {
  note(key, unit, Bounded{.value = value});
}

// Records the median of samples.
void note_samples(const std::string& key, const std::string& unit, Real median, Real least, Real most);

// The numbers from here on are those of a GPU with this name instead of the processor's.
void measured_on_gpu(const std::string& name);
// The command line begins with mpirun.
void measured_on_ranks(int ranks);
std::string processor_name();  // from /proc/cpuinfo

// Records the bounds and the result of a check, and returns it for CHECK().
template <class Check>
Check measured(const std::string& key, const std::string& unit, Check check) {
  note(key, unit, bounded(check));
  return check;
}

}  // namespace scree
