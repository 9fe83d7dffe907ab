#include "experiments/verification/truth.h"

#include <cstdio>
#include <fstream>

namespace anchord {

Result<Truth> read_truth(const std::string& file) {
  std::ifstream lines(file);
  if (!lines) return Error{ErrorCode::kIo, file, "cannot be read"};
  Truth truth;
  std::string line;
  std::getline(lines, line);
  for (int number = 2; std::getline(lines, line); ++number) {
    int frame = 0, person = 0;
    double x = 0, y = 0;
    if (std::sscanf(line.c_str(), "%d,%d,%lf,%lf", &frame, &person, &x, &y) != 4) {
      return invalid(file, "line " + std::to_string(number) + " is not frame,id,x,y");
    }
    truth[person][frame] = {x, y};
  }
  return truth;
}

}  // namespace anchord
