// A program of somebody else's: reads a configuration, passes a cup through the LCM types into the
// engine, and asks what is there.

#include <iostream>

#include "anchord/frame_t.hpp"
#include "anchoring/reading.h"
#include "anchoring/world.h"
#include "knowledge/configuration.h"
#include "lcmtypes/checked_decode.h"
#include "lcmtypes/codec.h"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const anchord::Configuration configuration = anchord::read_configuration(argv[1]);
  for (const auto& mistake : configuration.mistakes()) std::cerr << mistake.text() << '\n';
  if (!configuration.ok()) return 1;

  anchord::Frame frame;
  frame.utime = 1700000000000000;
  frame.sensor = "kinect";
  anchord::Detection cup;
  cup.measurement = anchord::CartesianMeasurement{{2, 2, 0.9}, {}};
  cup.attributes = {{"class", anchord::SymbolReport{{{"cup", 0.9}}}}};
  frame.detections = {cup};

  const std::vector<std::uint8_t> bytes = anchord::encode(frame, 1);
  anchord::frame_t generated;
  if (generated.decode(bytes.data(), 0, static_cast<int>(bytes.size())) < 0) return 1;
  const auto message = anchord::decode_frame(bytes);
  if (!message.ok() || generated.sensor != message->frame.sensor) return 1;

  anchord::World world(configuration.knowledge());
  if (const auto status = world.apply(message->frame); !status.ok()) {
    std::cerr << status.error().text() << '\n';
    return 1;
  }
  const auto objects = anchord::read_objects(*world.belief(), frame.utime, 0, *world.background());
  std::cout << objects.size() << " object, p = " << objects.at(0).p << '\n';
  return objects.size() == 1 ? 0 : 1;
}
