// A whole particle file.
#pragma once

#include <string>

#include "model/builder/particle_file.hpp"

namespace scree {

// All columns of a file. Throws as ParticleFile does.
inline ParticleColumns read_particle_file(const std::string& path, int dimension) {
  const ParticleFile file(path, dimension);
  return file.read({0, file.count()});
}

}  // namespace scree
