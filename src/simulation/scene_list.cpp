// Every scene by its name.
#include <stdexcept>

#include "donex/simulation/simulator.h"
#include "scenes.h"

namespace donex::simulation {
namespace {

struct Entry {
  const char* name;
  const char* meaning;
  Scene (*make)(std::uint64_t seed);
};

constexpr Entry kScenes[] = {
    {"intersection", "a crossroads with traffic and people, the sensor at rest", makeIntersection},
    {"street", "round a block of houses, parked cars on both sides, traffic, cyclists, people", makeStreet},
    {"motorway", "three lanes each way at 29 m/s, lorries, guard rails, bridges", makeMotorway},
    {"bend", "a roundabout and the bends of the road that leads back to it", makeBend},
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
    for (const Entry& entry : kScenes) all.push_back(entry.name);
    return all;
  }();
  return names;
}

std::string sceneMeaning(const std::string& scene) { return entryOf(scene).meaning; }

std::string unknownScene(const std::string& name) {
  std::string text = "no scene '" + name + "'; there are:";
  for (const Entry& entry : kScenes) text += std::string(" ") + entry.name;
  return text;
}

Scene makeScene(const std::string& name, std::uint64_t seed) {
  return entryOf(name).make(scramble(seed));
}

}  // namespace donex::simulation
