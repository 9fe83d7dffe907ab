#pragma once

#include <memory>
#include <vector>

#include "core/pool.h"
#include "models/footprint.h"

namespace anchord {

/// How high a density over a footprint is in each cell, over the uniform one. Kept block by block:
/// the blocks that a look did not touch are shared with the density before the look, which differs
/// there by a factor and by what entered everywhere alike. Uniform at first. A value.
class RelativeHeights {
 public:
  explicit RelativeHeights(const Footprint& footprint) : parts_(footprint.blocks()) {}

  double at(int cell, const Footprint& footprint) const {
    const int block = footprint.block_of[cell];
    const Part& part = parts_[block];
    return part.block
               ? part.scale * part.block->height[cell - footprint.first_of[block]] + part.offset
               : part.offset;
  }

  /// Of each cell the height becomes scale times what it is plus offset; both >= 0.
  void change(double scale, double offset);
  /// Of the cells where it is, that is multiplied by 1 - p share, too.
  void miss(double p, const CellShares& visible, const Footprint& footprint);
  /// The sum of u times these and 1 - u times others.
  void mix(double u, const RelativeHeights& others, const Footprint& footprint);
  /// Heights cell by cell.
  void set(const std::vector<double>& heights, const Footprint& footprint);

  /// The mass of a density of these heights: 1 if that is normalised.
  double mass(const Footprint& footprint) const;
  /// That times the shares.
  double mass(const CellShares& shares, const Footprint& footprint) const;

  /// Whether these are heights over that footprint.
  bool fits(const Footprint& footprint) const;

  template <typename Archive>
  void serialize(Archive& archive) {
    archive(parts_);
  }
  RelativeHeights() = default;  ///< to be read into

 private:
  struct Block {
    double mass = 0;  ///< the sum of share times height
    PoolVector<double> height;
    template <typename Archive>
    void serialize(Archive& archive) {
      archive(mass, height);
    }
  };
  /// The heights are scale times the block's plus offset; without a block, offset.
  struct Part {
    std::shared_ptr<const Block> block;
    double scale = 0, offset = 1;
    template <typename Archive>
    void serialize(Archive& archive) {
      archive(block, scale, offset);
    }
  };

  PoolVector<Part> parts_;
};

}  // namespace anchord
