#include "experiments/soak/home.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace anchord::experiment {
namespace {

/// What stands and lies about, where it is put, and whether people carry it about.
struct Stock {
  const char* name;
  int count;
  std::array<const char*, 4> places;
  bool portable;
};
constexpr std::array<Stock, 22> kStock{{
    {"cup", 3, {"kitchen_table", "kitchen_counter", "coffee_table", "desk"}, true},
    {"mug", 2, {"desk", "coffee_table", "kitchen_counter", "desk"}, true},
    {"glass", 2, {"dining_table", "night_stand", "sink", "dining_table"}, true},
    {"bottle", 1, {"kitchen_counter", "dining_table", "coffee_table", "desk"}, true},
    {"plate", 2, {"dining_table", "kitchen_table", "sink", "dining_table"}, true},
    {"bowl", 1, {"kitchen_table", "sink", "kitchen_table", "coffee_table"}, true},
    {"pan", 1, {"kitchen_counter", "sink", "kitchen_counter", "sink"}, true},
    {"kettle",
     1,
     {"kitchen_counter", "kitchen_counter", "kitchen_counter", "kitchen_counter"},
     false},
    {"cereal_box",
     1,
     {"kitchen_table", "kitchen_counter", "kitchen_table", "kitchen_counter"},
     true},
    {"tea_box", 1, {"kitchen_counter", "kitchen_table", "kitchen_counter", "kitchen_table"}, true},
    {"fruit", 3, {"kitchen_table", "dining_table", "kitchen_counter", "coffee_table"}, true},
    {"book", 4, {"bookcase", "shelves", "night_stand", "couch"}, true},
    {"phone", 1, {"desk", "coffee_table", "night_stand", "couch"}, true},
    {"laptop", 1, {"desk", "kitchen_table", "couch", "desk"}, true},
    {"remote", 1, {"couch", "coffee_table", "couch", "coffee_table"}, true},
    {"keys", 1, {"shoe_rack", "kitchen_counter", "shoe_rack", "desk"}, true},
    {"bag", 1, {"hall", "study", "bedroom", "hall"}, true},
    {"shoe", 2, {"shoe_rack", "hall", "shoe_rack", "hall"}, true},
    {"pillow", 2, {"couch", "bed", "couch", "bed"}, false},
    {"chair", 4, {"kitchen", "living_room", "study", "living_room"}, false},
    {"plant", 2, {"living_room", "bedroom", "study", "living_room"}, false},
    {"toy", 2, {"living_room", "bedroom", "couch", "hall"}, true},
}};
constexpr std::array<const char*, 6> kRooms{"kitchen", "living_room", "hall",
                                            "bedroom", "bathroom",    "study"};
const Eigen::Vector2d kDoor(11.6, 4.55);
constexpr double kReach = 1.5;       // m, within which a thing is taken along
constexpr double kCarries = 0.5;     // of the ways within the home, if there is a thing
constexpr double kPutAway = 0.1;     // of what is put down: into a cupboard or the dishwasher
constexpr double kCupboard = 7200;   // s, mean
constexpr double kHandHeight = 1.1;  // m

const Stock* stock_of(const std::string& name) {
  const auto found = std::find_if(kStock.begin(), kStock.end(),
                                  [&](const Stock& stock) { return name == stock.name; });
  return found == kStock.end() ? nullptr : found;
}

}  // namespace

Home::Home(const Knowledge& knowledge, const Site& site, std::uint64_t seed)
    : knowledge_(knowledge), site_(site), dice_(seed) {
  furnish();
  const int person = knowledge.find_class("person"), cat = knowledge.find_class("cat");
  for (int i = 0; i < 5; ++i) {
    Dweller dweller;
    dweller.object_class = i < 4 ? person : cat;
    dweller.height = i < 4 ? 0.9 : 0.15;
    dweller.color = static_cast<int>(dice_.uniform(0, 11));
    dweller.leaves = i < 2 ? 0.05 : i < 4 ? 0.3 : 0;  // two live here, two visit
    if (i == 2 || i == 3) dweller.away = 10'800;
    if (i == 4) dweller.rest = 600, dweller.speed = 0.7;
    const Eigen::Vector3d at = spot(kRooms[static_cast<std::size_t>(i)]);
    dweller.position = at.head<2>();
    dweller.here = i < 2 || i == 4;
    dweller.until = after(dweller.here ? dweller.rest : dweller.away);
    dwellers_.push_back(dweller);
  }
}

void Home::furnish() {
  for (const Stock& stock : kStock)
    for (int i = 0; i < stock.count; ++i) {
      HomeThing thing;
      thing.object_class = knowledge_.find_class(stock.name);
      thing.color = static_cast<int>(dice_.uniform(0, 11));
      thing.position = spot(stock.places[static_cast<std::size_t>(i) % stock.places.size()]);
      things_.push_back(thing);
    }
}

void Home::step(double dt) {
  now_ += dt;
  for (HomeThing& thing : things_)
    if (!thing.here() && now_ >= thing.returns) thing.returns = 0;
  for (int who = 0; who < static_cast<int>(dwellers_.size()); ++who) {
    Dweller& dweller = dwellers_[static_cast<std::size_t>(who)];
    if (!dweller.way.empty()) {
      walk(dweller, dweller.speed * dt);
      if (dweller.carries >= 0)
        things_[static_cast<std::size_t>(dweller.carries)].position = {
            dweller.position.x(), dweller.position.y(), kHandHeight};
      if (dweller.way.empty()) arrive(who);
    } else if (now_ >= dweller.until) {
      get_up(who);
    }
  }
}

void Home::get_up(int who) {
  Dweller& dweller = dwellers_[static_cast<std::size_t>(who)];
  if (!dweller.here) {  // comes home
    dweller.here = true;
    dweller.position = kDoor;
  } else if (dice_.happens(dweller.leaves)) {
    set_out(dweller, kDoor);
    return;
  }
  const bool is_cat = dweller.height < 0.5;
  if (!is_cat && dice_.happens(kCarries)) take_along(who);
  Eigen::Vector2d to = dweller.puts.head<2>();
  if (dweller.carries < 0)
    to = spot(kRooms[static_cast<std::size_t>(dice_.uniform(0, kRooms.size()))]).head<2>();
  set_out(dweller, to);
}

void Home::take_along(int who) {
  Dweller& dweller = dwellers_[static_cast<std::size_t>(who)];
  for (int i = 0; i < static_cast<int>(things_.size()); ++i) {
    HomeThing& thing = things_[static_cast<std::size_t>(i)];
    const Stock* stock =
        stock_of(knowledge_.classes[static_cast<std::size_t>(thing.object_class)].name);
    if (!stock || !stock->portable || !thing.here() || thing.carrier >= 0) continue;
    if ((thing.position.head<2>() - dweller.position).norm() > kReach) continue;
    dweller.carries = i;
    dweller.puts = spot(stock->places[static_cast<std::size_t>(dice_.uniform(0, 4))]);
    thing.carrier = who;
    return;
  }
}

void Home::arrive(int who) {
  Dweller& dweller = dwellers_[static_cast<std::size_t>(who)];
  if (dweller.carries >= 0) {
    HomeThing& thing = things_[static_cast<std::size_t>(dweller.carries)];
    thing.position = dweller.puts;
    thing.carrier = dweller.carries = -1;
    if (dice_.happens(kPutAway)) thing.returns = after(kCupboard);
  }
  dweller.here = dweller.position != kDoor;
  dweller.until = after(dweller.here ? dweller.rest : dweller.away);
}

void Home::set_out(Dweller& dweller, const Eigen::Vector2d& to) {
  const Way way = site_.ways.way(site_.ways.start(dweller.position), to);
  dweller.way.assign(way.points.rbegin(), way.points.rend());
  if (dweller.way.empty()) dweller.way = {to};  // no way around the walls is known: straight on
}

void Home::walk(Dweller& dweller, double most) {
  while (!dweller.way.empty()) {
    const Eigen::Vector2d left = dweller.way.back() - dweller.position;
    const double length = left.norm();
    if (length > most) {
      dweller.position += most / length * left;
      return;
    }
    dweller.position = dweller.way.back();
    dweller.way.pop_back();
    most -= length;
  }
}

/// A point in a place, at the height at which things stand there.
Eigen::Vector3d Home::spot(const std::string& name) {
  const Place& place = knowledge_.places[static_cast<std::size_t>(knowledge_.find_place(name))];
  const bool floor = place.kind == "room";
  Eigen::Vector2d low = place.region.polygon[0], high = low;
  for (const Eigen::Vector2d& corner : place.region.polygon) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const double margin = floor ? 0.4 : 0.03;  // m, from walls and edges
  const double z = floor ? 0.3 : place.region.z_min + 0.1;
  while (true) {
    const double x = dice_.uniform(low.x() + margin, high.x() - margin);
    const Eigen::Vector3d at(x, dice_.uniform(low.y() + margin, high.y() - margin), z);
    if (place.region.contains(at, 3)) return at;
  }
}

/// Some time from now, exponentially distributed.
double Home::after(double mean) { return now_ - mean * std::log(dice_.uniform()); }

}  // namespace anchord::experiment
