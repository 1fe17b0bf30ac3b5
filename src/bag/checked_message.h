// Messages from bytes of unknown origin. What ROS generates to read them makes room for as many elements as a message
// claims to have, before it looks whether the bytes are there: four of them can ask for 200 GB.
#pragma once

#include <boost/shared_ptr.hpp>
#include <fmt/format.h>
#include <ros/exception.h>
#include <ros/message_traits.h>
#include <ros/serialization.h>
#include <rosbag/message_instance.h>
#include <sensor_msgs/PointCloud2.h>
#include <tf2_msgs/TFMessage.h>

#include "io/data_error.h"

namespace donex {

/// Takes a count from the stream. Throws StreamOverrunException when the stream is too short for so many elements of
/// at least `bytes`.
inline std::uint32_t takeCount(ros::serialization::IStream& stream, std::uint32_t bytes) {
  std::uint32_t count = 0;
  stream.next(count);
  if (count > stream.getLength() / bytes) ros::serialization::throwStreamOverrun();
  return count;
}

/// Throws StreamOverrunException when the message is shorter than it claims.
template <class Message>
void requireClaims(ros::serialization::IStream /*stream*/, const Message&) {}

inline void requireClaims(ros::serialization::IStream stream, const sensor_msgs::PointCloud2& cloud) {
  constexpr std::uint32_t kNamelessField = 13;  // bytes
  std_msgs::Header header;
  sensor_msgs::PointField field;
  std::uint32_t number = 0;
  std::uint8_t flag = 0;
  stream.next(header);
  for (int i = 0; i < 2; ++i) stream.next(number);  // height, width
  for (auto fields = takeCount(stream, kNamelessField); fields != 0; --fields) stream.next(field);
  stream.next(flag);
  for (int i = 0; i < 2; ++i) stream.next(number);  // steps
  takeCount(stream, sizeof(cloud.data[0]));
}

inline void requireClaims(ros::serialization::IStream stream, const tf2_msgs::TFMessage& /*transforms*/) {
  constexpr std::uint32_t kNamelessTransform = 76;  // bytes
  takeCount(stream, kNamelessTransform);
}

/// Passes for a Message where one is read.
template <class Message>
struct Checked {
  Message message;
};

}  // namespace donex

namespace ros {
namespace message_traits {
template <class Message>
struct MD5Sum<donex::Checked<Message>> : MD5Sum<Message> {};
template <class Message>
struct DataType<donex::Checked<Message>> : DataType<Message> {};
}  // namespace message_traits

namespace serialization {
template <class Message>
struct Serializer<donex::Checked<Message>> {
  static void read(IStream& stream, donex::Checked<Message>& checked) {
    donex::requireClaims(stream, checked.message);
    stream.next(checked.message);
  }
};
}  // namespace serialization
}  // namespace ros

namespace donex {

/// The message of that type; throws DataError where the bytes are not one.
template <class Message>
typename Message::ConstPtr parse(const rosbag::MessageInstance& message) {
  try {
    const auto parsed = message.instantiate<Checked<Message>>();
    if (parsed) return typename Message::ConstPtr(parsed, &parsed->message);
  } catch (const ros::Exception& error) {
    throw DataError(fmt::format("{} at {:.9f} s: cannot be read ({})", message.getTopic(), message.getTime().toSec(),
                                error.what()));
  }
  throw DataError(fmt::format("{} at {:.9f} s: is not a {}", message.getTopic(), message.getTime().toSec(),
                              ros::message_traits::DataType<Message>::value()));
}

}  // namespace donex
