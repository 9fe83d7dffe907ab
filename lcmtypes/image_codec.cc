#include "lcmtypes/image_codec.h"

#include <anchord/image_t.hpp>
#include <utility>

#include "lcmtypes/codec.h"
#include "lcmtypes/conversion.h"
#include "lcmtypes/wire_check.h"

namespace anchord {

Result<ImageMessage> decode_image(std::span<const std::uint8_t> bytes) {
  auto message = decode_checked<image_t>(check_image(bytes), bytes);
  if (!message) return message.error();
  ImageMessage image;
  image.utime = message->utime;
  image.seq = message->seq;
  image.robot = message->robot;
  image.sensor = message->sensor;
  if (message->has_pose) image.pose = from_lcm(message->pose);
  image.width = message->width;
  image.height = message->height;
  image.format = static_cast<ImageMessage::Format>(message->format);
  image.data = std::move(message->data);
  return image;
}

std::vector<std::uint8_t> encode(const ImageMessage& image) {
  image_t message{};
  message.utime = image.utime;
  message.seq = image.seq;
  message.robot = wire_text(image.robot);
  message.sensor = wire_text(image.sensor);
  message.has_pose = image.pose.has_value();
  if (image.pose) message.pose = to_lcm(*image.pose);
  message.width = image.width;
  message.height = image.height;
  message.format = static_cast<std::int8_t>(image.format);
  message.data = image.data;
  message.num_bytes = static_cast<std::int32_t>(image.data.size());
  return encode_message(message);
}

}  // namespace anchord
