// Fields of a snapshot that never change, though the deck asks for them.
#pragma once

#include <string>

#include "model/data/model.hpp"

namespace scree {

// A warning where output.fields names fields of rotation and no particle rotates; "" elsewhere.
std::string still_fields(const Model& model);

}  // namespace scree
