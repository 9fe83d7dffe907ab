#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "image_inbox.h"
#include "image_picture.h"
#include "tasks.h"

namespace anchord {
namespace {

using Format = ImageMessage::Format;
const cv::Size kSize(8, 4);

ImageMessage image(Format format, std::size_t bytes, Utime utime = kNow) {
  ImageMessage image;
  image.utime = utime;
  image.sensor = "camera";
  image.width = kSize.width;
  image.height = kSize.height;
  image.format = format;
  image.data.assign(bytes, 100);
  return image;
}

ImageMessage jpeg(const cv::Size& size) {
  ImageMessage result = image(Format::kJpeg, 0);
  cv::imencode(".jpg", cv::Mat(size, CV_8UC3, cv::Scalar(10, 200, 30)), result.data);
  return result;
}

TEST(ToPicture, ReadsEveryFormat) {
  EXPECT_EQ(to_picture(image(Format::kBgr8, 96), kSize)->at<cv::Vec3b>(3, 7), cv::Vec3b::all(100));
  EXPECT_EQ(to_picture(image(Format::kGray8, 32), kSize)->at<cv::Vec3b>(3, 7), cv::Vec3b::all(100));
  const auto picture = to_picture(jpeg(kSize), kSize);
  ASSERT_TRUE(picture) << picture.error().text();
  EXPECT_NEAR(picture->at<cv::Vec3b>(1, 1)[1], 200, 6);  // as exact as a JPEG of quality 95
  const auto depth = to_depth(image(Format::kDepth16Mm, 64), kSize);
  ASSERT_TRUE(depth);
  EXPECT_FLOAT_EQ((*depth)(3, 7), 25.7F);  // 100 + 256 * 100 mm
}

TEST(ToPicture, RefusesWhatIsNotOfTheCamerasSize) {
  EXPECT_FALSE(to_picture(image(Format::kBgr8, 95), kSize));
  EXPECT_FALSE(to_picture(image(Format::kBgr8, 96), {4, 8}));
  EXPECT_FALSE(to_picture(image(Format::kDepth16Mm, 64), kSize));
  EXPECT_FALSE(to_depth(image(Format::kDepth16Mm, 63), kSize));
  EXPECT_FALSE(to_depth(image(Format::kGray8, 32), kSize));
}

TEST(ToPicture, UnpacksNoJpegThatIsLargerThanItSays) {
  const auto refused = to_picture(jpeg({64, 64}), kSize);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().field, "data");
}

TEST(ToPicture, SurvivesDamagedJpegs) {
  const ImageMessage good = jpeg(kSize);
  for (std::size_t length = 0; length < good.data.size(); ++length) {
    ImageMessage cut = good;
    cut.data.resize(length);
    const auto picture = to_picture(cut, kSize);  // a picture that ends early may still be one
    if (picture) {
      EXPECT_EQ(picture->size(), kSize);
    }
  }
}

TEST(ImageInbox, HandsOutTheNewestOnce) {
  ImageInbox inbox("", "camera", kSize);
  EXPECT_FALSE(inbox.wait(0));
  EXPECT_TRUE(inbox.add(image(Format::kBgr8, 96, kNow)));
  EXPECT_TRUE(inbox.add(image(Format::kBgr8, 96, kNow + 1)));
  const auto picture = inbox.wait(0);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->utime, kNow + 1);
  EXPECT_FALSE(inbox.wait(0));
  EXPECT_FALSE(inbox.add(image(Format::kBgr8, 96, kNow)));  // older
}

TEST(ImageInbox, PutsDepthBesideColorOfItsTime) {
  ImageInbox inbox("", "camera", kSize);
  EXPECT_TRUE(inbox.add(image(Format::kDepth16Mm, 64, kNow)));
  EXPECT_TRUE(inbox.add(image(Format::kBgr8, 96, kNow + ImageInbox::kTogether)));
  EXPECT_FALSE(inbox.wait(0)->picture.depth.empty());
  EXPECT_TRUE(inbox.add(image(Format::kBgr8, 96, kNow + ImageInbox::kTogether + 1)));
  EXPECT_TRUE(inbox.wait(0)->picture.depth.empty());
}

TEST(ImageInbox, LeavesOtherCamerasAlone) {
  ImageInbox inbox("amigo", "camera", kSize);
  EXPECT_TRUE(inbox.add(image(Format::kBgr8, 96)));  // of no robot
  EXPECT_FALSE(inbox.wait(0));
}

TEST(ImageInbox, RefusesACameraThatMoves) {
  ImageInbox inbox("", "camera", kSize);
  ImageMessage moving = image(Format::kBgr8, 96);
  moving.pose = Pose{};
  EXPECT_FALSE(inbox.add(moving));
}

}  // namespace
}  // namespace anchord
