#include "models/relative_heights.h"

#include <Eigen/Core>

namespace anchord {
namespace {

using Cells = Eigen::Map<Eigen::ArrayXd>;
using ConstCells = Eigen::Map<const Eigen::ArrayXd>;

/// What of values by cell is a block's.
ConstCells in_block(const double* by_cell, int block, const Footprint& footprint) {
  const int first = footprint.first_of[block];
  return {by_cell + first, footprint.first_of[block + 1] - first};
}

template <typename Vector>
ConstCells all_of(const Vector& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

}  // namespace

void RelativeHeights::change(double scale, double offset) {
  for (Part& part : parts_) {
    part.scale *= scale;
    part.offset = scale * part.offset + offset;
  }
}

void RelativeHeights::miss(double p, const CellShares& visible, const Footprint& footprint) {
  for (const int b : visible.blocks()) {
    Part& part = parts_[b];
    const auto missed = 1 - p * in_block(visible.data(), b, footprint);
    auto next = make_pooled<Block>();
    next->height.resize(static_cast<std::size_t>(missed.size()));
    Cells height(next->height.data(), missed.size());
    if (part.block)
      height = (part.scale * all_of(part.block->height) + part.offset) * missed;
    else
      height = part.offset * missed;
    next->mass = (height * in_block(footprint.share.data(), b, footprint)).sum();
    part = {std::move(next), 1, 0};
  }
}

void RelativeHeights::mix(double u, const RelativeHeights& others, const Footprint& footprint) {
  for (int b = 0; b < footprint.blocks(); ++b) {
    Part& part = parts_[b];
    const Part& other = others.parts_[b];
    const double offset = u * part.offset + (1 - u) * other.offset;
    if (part.block == other.block) {
      part = {part.block, u * part.scale + (1 - u) * other.scale, offset};
    } else if (!part.block || !other.block) {
      part = part.block ? Part{part.block, u * part.scale, offset}
                        : Part{other.block, (1 - u) * other.scale, offset};
    } else {
      auto next = make_pooled<Block>();
      next->height.resize(part.block->height.size());
      Cells(next->height.data(), static_cast<Eigen::Index>(next->height.size())) =
          u * part.scale * all_of(part.block->height) +
          (1 - u) * other.scale * all_of(other.block->height);
      next->mass = u * part.scale * part.block->mass + (1 - u) * other.scale * other.block->mass;
      part = {std::move(next), 1, offset};
    }
  }
}

void RelativeHeights::set(const std::vector<double>& heights, const Footprint& footprint) {
  for (int b = 0; b < footprint.blocks(); ++b) {
    const ConstCells own = in_block(heights.data(), b, footprint);
    auto next = make_pooled<Block>();
    next->height.assign(own.begin(), own.end());
    next->mass = (own * in_block(footprint.share.data(), b, footprint)).sum();
    parts_[b] = {std::move(next), 1, 0};
  }
}

double RelativeHeights::mass(const Footprint& footprint) const {
  double sum = 0;
  for (int b = 0; b < footprint.blocks(); ++b) {
    const Part& part = parts_[b];
    sum += part.offset * footprint.block_share[b];
    if (part.block) sum += part.scale * part.block->mass;
  }
  return sum;
}

double RelativeHeights::mass(const CellShares& shares, const Footprint& footprint) const {
  double sum = 0;
  for (const int b : shares.blocks()) {
    const Part& part = parts_[b];
    const auto counted =
        in_block(footprint.share.data(), b, footprint) * in_block(shares.data(), b, footprint);
    if (part.block)
      sum += (counted * (part.scale * all_of(part.block->height) + part.offset)).sum();
    else
      sum += part.offset * counted.sum();
  }
  return sum;
}

bool RelativeHeights::fits(const Footprint& footprint) const {
  if (parts_.size() != static_cast<std::size_t>(footprint.blocks())) return false;
  for (int b = 0; b < footprint.blocks(); ++b) {
    const int cells = footprint.first_of[b + 1] - footprint.first_of[b];
    if (const auto& block = parts_[b].block;
        block && block->height.size() != static_cast<std::size_t>(cells))
      return false;
  }
  return true;
}

}  // namespace anchord
