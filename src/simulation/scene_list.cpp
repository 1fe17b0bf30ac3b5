// Every scene by its name.
#include <array>
#include <stdexcept>

#include "simulation/scenes.h"
#include "simulation/simulator.h"

namespace donex::simulation {
namespace {

struct Entry {
  const char* name;
  const char* meaning;
  Scene (*make)(std::uint64_t seed);
  bool has_vehicle = true;
};

constexpr std::array kScenes{
    Entry{"intersection", "a crossroads with traffic and people, the sensor at rest", makeIntersection},
    Entry{"street", "round a block of houses, parked cars on both sides, traffic, cyclists, people", makeStreet},
    Entry{"motorway", "three lanes each way at 29 m/s, lorries, guard rails, bridges", makeMotorway},
    Entry{"bend", "a roundabout and the bends of the road that leads back to it", makeBend},
    Entry{"lead_vehicle", "a vehicle ahead at the ego vehicle's own speed", makeLeadVehicle},
    Entry{"oncoming", "a country road with oncoming traffic at 30 m/s", makeOncoming},
    Entry{"pedestrian_slow", "people on foot at 0.8 m/s", makePedestrianSlow},
    Entry{"crowd", "a shopping street full of people, some of them standing", makeCrowd},
    Entry{"stop_and_go", "the car ahead brakes to a stop and starts again, and so does the oncoming traffic",
          makeStopAndGo},
    Entry{"parked_car_leaves", "parked cars pull out on both sides", makeParkedCarLeaves},
    Entry{"foliage", "hedges, bushes and trees in a light wind, people and cyclists between them", makeFoliage},
    Entry{"fences", "picket fences and guard rails at grazing angles, people behind them", makeFences},
    Entry{"bridges", "bridges, gantries and branches overhead", makeBridges},
    Entry{"slope", "over a hill of 7 to 11 %", makeSlope},
    Entry{"turning", "round and round at 30 degrees a second", makeTurning},
    Entry{"standstill_start", "stands at a traffic light, then starts", makeStandstillStart},
    Entry{"queue", "two queues that creep at 1 m/s, stop and start, the ego vehicle in one of them", makeQueue},
    Entry{"doors", "doors of parked cars open on both sides", makeDoors},
    Entry{"far_people", "people on foot 25 to 48 m away: few echoes each", makeFarPeople},
    Entry{"corners", "people, cyclists and cars come out from behind walls", makeCorners},
    Entry{"empty_room", "a room at rest, seen by a 16-beam sensor: nothing moves", makeEmptyRoom, false},
};

const Entry* find(const std::string& name) {
  for (const Entry& entry : kScenes) {
    if (name == entry.name) return &entry;
  }
  return nullptr;
}

const Entry& entryOf(const std::string& name) {
  const Entry* entry = find(name);
  if (entry == nullptr) throw std::invalid_argument(unknownScene(name));
  return *entry;
}

}  // namespace

const std::vector<std::string>& sceneNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    all.reserve(kScenes.size());
    for (const Entry& entry : kScenes) all.emplace_back(entry.name);
    return all;
  }();
  return names;
}

bool isScene(const std::string& name) { return find(name) != nullptr; }

bool hasVehicle(const std::string& scene) { return entryOf(scene).has_vehicle; }

std::string sceneMeaning(const std::string& scene) { return entryOf(scene).meaning; }

std::string unknownScene(const std::string& name) {
  std::string text = "no scene '" + name + "'; there are:";
  for (const Entry& entry : kScenes) text += std::string(" ") + entry.name;
  return text;
}

Scene makeScene(const std::string& name, std::uint64_t seed) { return entryOf(name).make(scramble(seed)); }

}  // namespace donex::simulation
