#include "ros/cloud_subscription.h"

#include <utility>

#include <boost/make_shared.hpp>
#include <ros/serialization.h>
#include <ros/subscription_callback_helper.h>

#include "ros/livox_cloud.h"

namespace donex {
namespace {

using sensor_msgs::PointCloud2;

/// roscpp asks the helper of a subscription what to make of the bytes. To it the type is PointCloud2, so a publisher's
/// own object is handed over as it is; a second subscription, or one to any type, would have each cloud serialised.
class CloudHelper : public ros::SubscriptionCallbackHelper {
 public:
  explicit CloudHelper(CloudReceiver receiver) : receiver_(std::move(receiver)) {}

  ros::VoidConstPtr deserialize(const ros::SubscriptionCallbackHelperDeserializeParams& sent) override {
    const std::string type = textOf(sent, "type"), md5 = textOf(sent, "md5sum");
    try {
      if (isLivox(type, md5)) return livoxCloud(sent.buffer, sent.length);
      const bool is_cloud = md5 == ros::message_traits::md5sum<PointCloud2>();
      if (is_cloud) return plainCloud(sent);
      receiver_.unreadable("messages of type " + type + " (md5 " + md5 +
                           "); read are sensor_msgs/PointCloud2, livox_ros_driver/CustomMsg and "
                           "livox_ros_driver2/CustomMsg as their drivers define them");
    } catch (const std::exception& error) {
      receiver_.unreadable("a " + type + " of " + std::to_string(sent.length) + " bytes: " + error.what());
    }
    return {};
  }

  void call(ros::SubscriptionCallbackHelperCallParams& arrived) override {
    receiver_.cloud(boost::static_pointer_cast<const PointCloud2>(arrived.event.getConstMessage()));
  }

  const std::type_info& getTypeInfo() override { return typeid(PointCloud2); }
  bool isConst() override { return true; }
  bool hasHeader() override { return true; }

 private:
  static std::string textOf(const ros::SubscriptionCallbackHelperDeserializeParams& sent, const std::string& key) {
    const auto found = sent.connection_header->find(key);
    return found == sent.connection_header->end() ? std::string() : found->second;
  }
  static ros::VoidConstPtr plainCloud(const ros::SubscriptionCallbackHelperDeserializeParams& sent) {
    auto cloud = boost::make_shared<PointCloud2>();
    ros::serialization::IStream stream(sent.buffer, sent.length);
    ros::serialization::deserialize(stream, *cloud);
    return cloud;
  }

  CloudReceiver receiver_;
};

}  // namespace

ros::Subscriber subscribeToClouds(ros::NodeHandle& nh, const std::string& topic, std::uint32_t queue_size,
                                  const CloudReceiver& receiver) {
  ros::SubscribeOptions options(topic, queue_size, "*", "*");
  options.helper = boost::make_shared<CloudHelper>(receiver);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  return nh.subscribe(options);
}

}  // namespace donex
