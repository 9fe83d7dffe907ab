// Prints the best world after every frame, and what the daemon refuses and why.

#include <anchord/rejected_t.hpp>
#include <anchord/world_t.hpp>
#include <cstdio>
#include <lcm/lcm-cpp.hpp>

namespace {

class Printer {
 public:
  void world(const lcm::ReceiveBuffer*, const std::string&, const anchord::world_t* world) {
    std::printf("%lld: %.2f objects expected\n", static_cast<long long>(world->utime),
                world->expected_count);
    for (const anchord::object_t& object : world->objects)
      std::printf("  %-12s p %.2f at %.2f %.2f %.2f %s\n", object.id.c_str(), object.p,
                  object.position[0], object.position[1], object.position[2], object.place.c_str());
    std::fflush(stdout);
  }
  void refusal(const lcm::ReceiveBuffer*, const std::string&, const anchord::rejected_t* refused) {
    std::printf("refused, %s: %s %s\n", refused->sensor.c_str(), refused->field.c_str(),
                refused->reason.c_str());
    std::fflush(stdout);
  }
};

}  // namespace

int main() {
  lcm::LCM lcm;
  if (!lcm.good()) return std::fputs("print_world: LCM cannot be opened\n", stderr), 1;
  Printer printer;
  lcm.subscribe("ANCHORD_WORLD", &Printer::world, &printer);
  lcm.subscribe("ANCHORD_REJECTED", &Printer::refusal, &printer);
  while (lcm.handle() == 0) {
  }
  return 1;
}
