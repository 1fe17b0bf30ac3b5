// Which topics of a bag are meant.
#pragma once

#include <string>
#include <vector>

#include <rosbag/view.h>

namespace donex {

using Datatypes = std::vector<std::string>;

/// The topic `wanted` (with or without a leading slash), which must be of one of these types; for an empty `wanted` the
/// only topic that is. Throws DataError that lists the bag's topics; `file` and `option` are for it.
std::string chooseTopic(rosbag::View& view, const std::string& wanted, const Datatypes& datatypes,
                        const std::string& file, const std::string& option);

bool hasTopicOf(rosbag::View& view, const std::string& datatype);

/// Throws DataError when the bag has the topic already.
void requireNewTopic(rosbag::View& view, const std::string& topic, const std::string& file);

/// Names are compared as absolute ones.
std::string absoluteTopic(const std::string& topic);

}  // namespace donex
