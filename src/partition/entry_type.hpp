// MPI types and counts of the messages of this folder.
#pragma once

#include <mpi.h>

#include <cstddef>
#include <limits>
#include <utility>

#include "base/error.hpp"

namespace scree {

// An MPI type for an entry, so that counts are those of entries; counts of bytes would exceed 2^31 sooner.
class EntryType {
 public:
  explicit EntryType(std::size_t bytes) {
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type_);
    MPI_Type_commit(&type_);
  }
  EntryType(EntryType&& other) noexcept : type_(std::exchange(other.type_, MPI_DATATYPE_NULL)) {}
  ~EntryType() {
    if (type_ != MPI_DATATYPE_NULL) MPI_Type_free(&type_);
  }
  EntryType& operator=(const EntryType&) = delete;
  operator MPI_Datatype() const { return type_; }

 private:
  MPI_Datatype type_;
};

// The count as an int. Throws SimulationError if MPI cannot count so many entries.
inline int mpi_count(std::size_t count) {
  if (count > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw SimulationError("more entries on one rank than MPI counts");
  return static_cast<int>(count);
}

}  // namespace scree
