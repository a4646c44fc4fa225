// A scratch folder visible to all ranks.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "partition/ranks.hpp"
#include "unit/output/scratch.hpp"

namespace scree {

// Created and removed by rank 0.
class SharedFolder {
 public:
  explicit SharedFolder(const Ranks& ranks) : ranks_(ranks) {
    char path[256] = {};
    ranks.on_root([&] {
      own_.emplace();
      own_->path().copy(path, sizeof path - 1);
    });
    ranks.broadcast(std::span<char>(path));
    path_ = path;
  }
  ~SharedFolder() { ranks_.any(false); }  // no rank reads any longer
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  Ranks ranks_;
  std::optional<ScratchDirectory> own_;
  std::string path_;
};

}  // namespace scree
