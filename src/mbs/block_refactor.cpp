#include "mbs/block_refactor.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <span>

namespace scree {

namespace {

constexpr int kMostRows = 96;     // the matrix and its factors stay in the processor's nearest caches
constexpr int kTogether = 4;      // columns whose updates alternate, as each waits for its own last one
constexpr std::size_t kThin = 2;  // entries of a block that must be in use on average

// A column of L or U in KLU's storage of a block: row indices, then values from the next multiple of eight
// bytes (klu_internal.h).
struct StoredColumn {
  std::span<const int> row;
  int first_value;  // counted in numbers from the start of the block
};

StoredColumn stored(const klu_numeric& numeric, const int* start, const int* length, int k) {
  const auto* numbers = static_cast<const double*>(numeric.LUbx[0]) + start[k];
  const auto entries = static_cast<std::size_t>(length[k]);
  const std::size_t units = (entries * sizeof(int) + sizeof(double) - 1) / sizeof(double);
  return {{reinterpret_cast<const int*>(numbers), entries}, start[k] + static_cast<int>(units)};
}

StoredColumn column_of_l(const klu_numeric& numeric, int k) {
  return stored(numeric, numeric.Lip, numeric.Llen, k);
}
StoredColumn column_of_u(const klu_numeric& numeric, int k) {
  return stored(numeric, numeric.Uip, numeric.Ulen, k);
}

double* factors_of(const klu_numeric& numeric) { return static_cast<double*>(numeric.LUbx[0]); }
double* pivots_of(const klu_numeric& numeric) { return static_cast<double*>(numeric.Udiag); }

}  // namespace

void BlockRefactor::plan(const SparsePattern& pattern, const double* values, const klu_symbolic& symbolic,
                         klu_numeric& numeric) {
  forget();
  const int n = symbolic.n;
  if (symbolic.nblocks != 1 || n > kMostRows || numeric.Rs != nullptr) return;
  row_blocks_ = (n + kWidth - 1) / kWidth;
  entries_.clear();
  std::vector<int> position(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) position[static_cast<std::size_t>(numeric.Pnum[k])] = k;
  for (int k = 0; k < n; ++k) {
    const auto column = static_cast<std::size_t>(symbolic.Q[k]);
    for (int p = pattern.row_start[column]; p < pattern.row_start[column + 1]; ++p) {
      const auto row = static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(p)]);
      entries_.push_back({p, k * row_blocks_ * kWidth + position[row]});
    }
  }
  plan_columns(symbolic, numeric);
  plan_updates(numeric);
  std::size_t single = 0;  // updates of KLU
  for (int k = 0; k < n; ++k)
    for (const int j : column_of_u(numeric, k).row) single += static_cast<std::size_t>(numeric.Llen[j]);
  if (single < kThin * updates_.size()) return forget();
  const std::vector<double> wanted = numbers(numeric);
  const bool done = refactor(values, numeric);
  const std::vector<double> found = numbers(numeric);
  if (done && std::memcmp(wanted.data(), found.data(), wanted.size() * sizeof(double)) == 0) return;
  for (std::size_t i = 0; i < upper_.size(); ++i) factors_of(numeric)[upper_[i].to] = wanted[i];
  for (std::size_t i = 0; i < lower_.size(); ++i)
    factors_of(numeric)[lower_[i].to] = wanted[upper_.size() + i];
  std::copy(wanted.end() - n, wanted.end(), pivots_of(numeric));
  forget();
}

// The factors' numbers: of U, of L, the pivots.
std::vector<double> BlockRefactor::numbers(const klu_numeric& numeric) const {
  std::vector<double> all;
  for (const std::vector<Copy>* part : {&upper_, &lower_})
    for (const Copy& copy : *part) all.push_back(factors_of(numeric)[copy.to]);
  all.insert(all.end(), pivots_of(numeric), pivots_of(numeric) + numeric.n);
  return all;
}

void BlockRefactor::plan_columns(const klu_symbolic& symbolic, const klu_numeric& numeric) {
  upper_.clear(), lower_.clear(), of_matrix_.clear(), mask_.clear();
  for (int k = 0; k < symbolic.n; ++k) {
    const StoredColumn u = column_of_u(numeric, k), l = column_of_l(numeric, k);
    const int first = k * row_blocks_;  // block of the matrix
    for (std::size_t i = 0; i < u.row.size(); ++i)
      upper_.push_back({first * kWidth + u.row[i], u.first_value + static_cast<int>(i)});
    std::map<int, int> block_of;  // by the block's number among the rows
    const int first_block = static_cast<int>(of_matrix_.size());
    for (const int row : l.row) block_of[row / kWidth] = 0;
    for (auto& [number, block] : block_of) {
      block = static_cast<int>(of_matrix_.size());
      of_matrix_.push_back(static_cast<std::uint16_t>(first + number));
      mask_.push_back(Mask{});
    }
    for (std::size_t i = 0; i < l.row.size(); ++i) {
      const int block = block_of[l.row[i] / kWidth], lane = l.row[i] % kWidth;
      mask_[static_cast<std::size_t>(block)][lane] = -1;
      lower_.push_back({block * kWidth + lane, l.first_value + static_cast<int>(i)});
    }
    columns_.push_back({0, first_block, static_cast<int>(of_matrix_.size())});
  }
  l_.assign(of_matrix_.size(), Block{});
  matrix_.assign(columns_.size() * static_cast<std::size_t>(row_blocks_), Block{});
}

// The updates of a few consecutive columns alternate up to the first that needs one of these columns.
void BlockRefactor::plan_updates(const klu_numeric& numeric) {
  updates_.clear();
  const int n = static_cast<int>(columns_.size());
  for (int first = 0; first < n; first += kTogether) {
    const int end = std::min(first + kTogether, n);
    std::vector<Update> early[kTogether], late[kTogether];
    std::size_t longest = 0;
    for (int k = first; k < end; ++k) {
      bool waits = false;
      for (const int j : column_of_u(numeric, k).row) {
        waits = waits || j >= first;
        const Column& source = columns_[static_cast<std::size_t>(j)];
        for (int b = source.first_block; b < source.end_block; ++b) {
          const int number = of_matrix_[static_cast<std::size_t>(b)] - j * row_blocks_;
          (waits ? late : early)[k - first].push_back(
              {static_cast<std::uint16_t>(k * row_blocks_ + number), static_cast<std::uint16_t>(b),
               static_cast<std::uint16_t>(k * row_blocks_ * kWidth + j)});
        }
      }
      longest = std::max(longest, early[k - first].size());
    }
    for (std::size_t i = 0; i < longest; ++i)
      for (const std::vector<Update>& updates : early)
        if (i < updates.size()) updates_.push_back(updates[i]);
    for (int k = first; k < end; ++k) {
      updates_.insert(updates_.end(), late[k - first].begin(), late[k - first].end());
      columns_[static_cast<std::size_t>(k)].updates_end = static_cast<int>(updates_.size());
    }
  }
}

bool BlockRefactor::refactor(const double* values, klu_numeric& numeric) {
  std::fill(matrix_.begin(), matrix_.end(), Block{});
  auto* matrix = reinterpret_cast<double*>(matrix_.data());
  double *factors = factors_of(numeric), *pivot = pivots_of(numeric);
  for (const Copy& entry : entries_) matrix[entry.to] = values[entry.from];
  const Update* update = updates_.data();
  const int stride = row_blocks_ * kWidth;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    const Column& column = columns_[k];
    for (const Update* const end = updates_.data() + column.updates_end; update != end; ++update)
      matrix_[update->target] -= l_[update->factor] * matrix[update->scale];
    pivot[k] = matrix[k * static_cast<std::size_t>(stride) + k];
    if (pivot[k] == 0) return false;
    for (auto b = static_cast<std::size_t>(column.first_block);
         b < static_cast<std::size_t>(column.end_block); ++b)
      l_[b] = reinterpret_cast<Block>(reinterpret_cast<Mask>(matrix_[of_matrix_[b]] / pivot[k]) & mask_[b]);
  }
  for (const Copy& copy : upper_) factors[copy.to] = matrix[copy.from];
  const auto* lower = reinterpret_cast<const double*>(l_.data());
  for (const Copy& copy : lower_) factors[copy.to] = lower[copy.from];
  return true;
}

}  // namespace scree
