#pragma once

#include <vector>

#include "anchoring/leaf.h"

namespace anchord {

/// What of one knowledge is what of another, by name: indices of the new one, or -1 (places: -2)
/// where there is none.
struct Correspondence {
  const Background& from;
  const Background& to;
  std::vector<int> classes;
  std::vector<int> attributes;            ///< -1 also where the kind is another
  std::vector<std::vector<int>> symbols;  ///< per attribute
  /// Whether a leaf is predicted as it was: classes, attributes and places are the same ones, in
  /// the same order, and the models, rates and grid too.
  bool same_dynamics = false;

  Correspondence(const Background& before, const Background& after);

  /// Of a place; -1 is the bounds, in both.
  int place(int old) const { return places_[old + 1]; }
  /// The models of a class as the new background numbers places and attributes.
  const std::vector<BehaviourModel>& models(int old_class) const { return models_[old_class]; }
  /// The old class that a class is; -1: it is new.
  int former_class(int c) const;
  /// The leaf at `utime`, up to which it has moved as the old knowledge says; as it is where the
  /// new one says the same.
  Leaf up_to(Leaf leaf, Utime utime) const;

 private:
  std::vector<int> places_;
  std::vector<std::vector<BehaviourModel>> models_;
};

}  // namespace anchord
