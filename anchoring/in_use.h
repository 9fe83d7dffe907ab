#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "anchoring/belief.h"
#include "anchoring/correspondence.h"
#include "core/result.h"

namespace anchord {

/// Which anchors use what a configuration may take away.
class InUse {
 public:
  /// At `utime`, not before that of any leaf. The correspondence must outlive it.
  InUse(const Correspondence& correspondence, Utime utime);

  /// Takes down what the leaves of a cluster use.
  void add(const Cluster& cluster);

  /// kConflict where something in use is no more: `field` is its path in the configuration, the
  /// message names it and who uses it. In use are the dimensions while there is any anchor, an
  /// attribute that a leaf holds, and the most probable class or symbol of any leaf.
  Status check() const;

 private:
  struct Users {
    std::map<std::uint64_t, std::string> ids;  ///< by birth
    std::string text() const;
    bool any() const { return !ids.empty(); }
  };
  void add(const Anchor& anchor, const Leaf& leaf);

  const Correspondence& of_;
  Utime utime_;
  Users all_;
  std::vector<Users> classes_, attributes_;
  std::vector<std::vector<Users>> symbols_;
};

}  // namespace anchord
