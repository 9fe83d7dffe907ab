#pragma once

#include <array>
#include <optional>

#include "geometry/gaussian.h"
#include "perception/blob_search.h"
#include "perception/camera.h"
#include "perception/verifier_settings.h"

namespace anchord {

/// A blob as an object of a known size.
struct MeasuredBlob {
  Gaussian position;      ///< map frame: of the object's position, as in body_of()
  double size_error = 0;  ///< ln of its size in the picture over the expected one; 0 where the
                          ///< distance was taken from the size
  double filled = 0;      ///< share of the expected pixels that it has
};

/// Where a blob's object is, and how exactly that is known. In a 2-D world it stands on the ground,
/// and its middle is half its height above: errors of the blob's middle and of the height move it.
/// In a 3-D world its distance is the blob's depth and half its own size behind, or, without a
/// depth image, that at which an object of `extent` looks as large as the blob does.
/// `expected_depth` (m) is where it is sought. Nothing where the blob's middle is above the
/// horizon.
std::optional<MeasuredBlob> measure(const Blob& blob, const Camera& camera,
                                    const std::array<double, 3>& extent, double expected_depth,
                                    int dims, const VerifierSettings& settings);

}  // namespace anchord
