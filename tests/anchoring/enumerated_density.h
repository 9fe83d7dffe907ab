#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/frame.h"
#include "knowledge/knowledge.h"

/// The densities of the enumeration, written for clarity and nothing else.
namespace anchord::enumeration {

/// An axis-aligned rectangle of the map: x_min, y_min, x_max, y_max.
using Rectangle = std::array<double, 4>;

/// Splits a polygon of axis-parallel edges into disjoint rectangles. Aborts on any other polygon.
std::vector<Rectangle> rectangles(const std::vector<Eigen::Vector2d>& polygon);

/// The probability that a normal point of the plane lies in a rectangle: a product of error
/// functions, or, where x and y are correlated, quadrature over x (error below 1e-13).
double probability(const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance,
                   const Rectangle& rectangle);

/// The normal density of `z`, in as many dimensions as it has.
double normal_density(const Eigen::VectorXd& z, const Eigen::VectorXd& mean,
                      const Eigen::MatrixXd& covariance);

/// e^A by a Taylor series of A / 2^k, squared k times.
Eigen::MatrixXd exponential(Eigen::MatrixXd a);

/// What a frame could see, in the map.
struct Sight {
  bool everything = false;
  std::vector<Rectangle> seen;            ///< nothing else is seen, unless `everything`
  std::string viewer = {};                ///< the sensor
  std::optional<Eigen::Vector3d> from{};  ///< it, if it said where it is

  /// The frame's view, else the sensor's, else none. Aborts on sectors, frusta and poses that turn.
  static Sight of(const Frame& frame, const Sensor& sensor, int dims);
  /// The distance of a point of the map from the sensor, m; 0 from nowhere.
  double range(const Eigen::VectorXd& point) const;
  bool contains(const Eigen::Vector2d& point) const;
};

/// The world's bounds in square cells, row by row, x fastest; in 3-D each is a full-height column.
struct Cells {
  explicit Cells(const Knowledge& knowledge);

  int dims;
  Eigen::Vector2d origin;
  double edge;  ///< m
  int columns, rows;
  double floor = 0, ceiling = 1;  ///< m; a 2-D world counts as 1 high

  int count() const { return columns * rows; }
  double volume() const { return edge * edge * (ceiling - floor); }  ///< of a cell, m^dims
  int find(const Eigen::VectorXd& point) const;                      ///< or -1; z is not looked at
  Eigen::Vector2d centre(int cell) const;
  /// The distance of a cell's column between two heights from the sensor, m: the centre's in the
  /// plane, the nearest height's.
  double range(int cell, double low, double high, const Sight& sight) const;
};

/// A region of whole cells between two heights.
struct Extent {
  Eigen::VectorXd uniform;  ///< per cell: 1 / number of cells in it, or 0
  double floor = 0, ceiling = 1;
};
/// Of a place, or of the bounds if `place` is -1. Aborts if it is not made of whole cells.
Extent extent(const Knowledge& knowledge, const Cells& cells, int place);

/// Mean and covariance of a state: position, or position then velocity.
struct Moments {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

/// The moments of the mixture of two densities with these weights, one of them positive.
Moments merge(double weight_a, const Moments& a, double weight_b, const Moments& b);

/// A state's moments as the state of a model: without velocity for one that has none; at rest,
/// with the model's initial velocity variance, for one that has one more than the state.
Moments fit(const Moments& state, const BehaviourModel& model, int dims);

/// An object's position alone, where a model that shares detections also holds how far its
/// detections are from it.
Moments alone(const Moments& state, const BehaviourModel& model, int dims);

/// The geometric mean of a state's standard deviations of position over its axes.
double spread(const Moments& state, int dims);

/// A part of a density, or what is left beside it, as small as this counts as none.
constexpr double kNothing = 1e-6;

/// What a sensor's looks have told of the part of a density that a view of mass v holds, see
/// SeenShare: here of any number of looks.
struct Looks {
  std::string viewer;
  double deviation = 0;            ///< the density's, at the last look
  std::map<double, double> share;  ///< by v

  /// The share of a part as it was after the last look; and as it is before another one.
  double at(double v) const;
  double at(double v, const std::string& by, double deviation_now) const;
  void miss(double v, double lost, const std::string& by, double deviation_now);
};
Looks merge(double weight_a, const Looks& a, double weight_b, const Looks& b);

/// One behaviour model's share of an object. A model of weight 0 may have no moments.
struct Density {
  double weight = 0;
  Moments state;          ///< tracked models
  Eigen::VectorXd cells;  ///< somewhere: the probability of each cell; flat inside a cell
  Looks looks = {};       ///< tracked models
};

/// Position moments of a `somewhere` density.
Moments moments(const Eigen::VectorXd& probabilities, const Cells& cells, const Extent& extent);

}  // namespace anchord::enumeration
