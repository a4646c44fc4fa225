#include "mbs/row_compliance.hpp"

#include <algorithm>
#include <utility>

namespace scree {

namespace {

using Entries = std::vector<std::vector<std::size_t>>;  // numbers of the entries of a SparseTerm, by row

Entries entries_by_row(const SparseTerm& term, std::size_t rows) {
  Entries entries(rows);
  for (std::size_t i = 0; i < term.size(); ++i) entries[static_cast<std::size_t>(term.row(i))].push_back(i);
  return entries;
}

}  // namespace

RowCompliance::RowCompliance(const SparseTerm& jacobian, const SparseTerm& inverse_mass, int constraints)
    : of_row_(static_cast<std::size_t>(constraints)) {
  int coordinates = 0;
  for (std::size_t i = 0; i < inverse_mass.size(); ++i)
    coordinates = std::max(coordinates, inverse_mass.row(i) + 1);
  const Entries of_constraint = entries_by_row(jacobian, of_row_.size()),
                of_coordinate = entries_by_row(inverse_mass, static_cast<std::size_t>(coordinates));
  first_.push_back(0);
  for (std::size_t row = 0; row < of_constraint.size(); ++row) {
    for (const std::size_t one : of_constraint[row])
      for (const std::size_t m : of_coordinate[static_cast<std::size_t>(jacobian.column(one))])
        for (const std::size_t other : of_constraint[row])
          if (jacobian.column(other) == inverse_mass.column(m) && inverse_mass.value(m) != 0)
            products_.push_back({static_cast<int>(one), static_cast<int>(other),
                                 kRelativeCompliance * inverse_mass.value(m)});
    first_.push_back(products_.size());
  }
}

void RowCompliance::update(const SparseTerm& jacobian) {
  for (std::size_t row = 0; row < of_row_.size(); ++row) {
    Real sum = 0;
    for (std::size_t i = first_[row]; i < first_[row + 1]; ++i) {
      const Product& p = products_[i];
      sum += p.weight * jacobian.value(static_cast<std::size_t>(p.one)) *
             jacobian.value(static_cast<std::size_t>(p.other));
    }
    of_row_[row] = sum;
  }
}

}  // namespace scree
