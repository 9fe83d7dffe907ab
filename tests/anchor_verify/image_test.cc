#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "image_inbox.h"
#include "image_picture.h"
#include "tasks.h"

namespace anchord {
namespace {

using Format = ImageMessage::Format;
const cv::Size kSize(8, 4);

CameraParameters camera(bool carried) {
  CameraParameters result;
  result.width = kSize.width;
  result.height = kSize.height;
  result.carried = carried;
  return result;
}
const CameraParameters kCamera = camera(false), kCarried = camera(true);

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
  ImageInbox inbox("", "camera", kCamera);
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
  ImageInbox inbox("", "camera", kCamera);
  EXPECT_TRUE(inbox.add(image(Format::kDepth16Mm, 64, kNow)));
  EXPECT_TRUE(inbox.add(image(Format::kBgr8, 96, kNow + ImageInbox::kTogether)));
  EXPECT_FALSE(inbox.wait(0)->picture.depth.empty());
  EXPECT_TRUE(inbox.add(image(Format::kBgr8, 96, kNow + ImageInbox::kTogether + 1)));
  EXPECT_TRUE(inbox.wait(0)->picture.depth.empty());
}

TEST(ImageInbox, LeavesOtherCamerasAlone) {
  ImageInbox inbox("amigo", "camera", kCamera);
  EXPECT_TRUE(inbox.add(image(Format::kBgr8, 96)));  // of no robot
  EXPECT_FALSE(inbox.wait(0));
}

ImageMessage posed(Format format, Utime utime, const Pose& pose = {}) {
  ImageMessage result = image(format, format == Format::kBgr8 ? 96 : 64, utime);
  result.pose = pose;
  return result;
}

std::string refused_field(ImageInbox& inbox, const ImageMessage& image) {
  const Status status = inbox.add(image);
  return status ? "" : status.error().field;
}

TEST(ImageInbox, ACameraThatStandsStillHasNoPose) {
  ImageInbox inbox("", "camera", kCamera);
  EXPECT_EQ(refused_field(inbox, posed(Format::kBgr8, kNow)), "pose");
  EXPECT_FALSE(inbox.wait(0));
}

TEST(ImageInbox, ACarriedCameraHasAPose) {
  ImageInbox inbox("", "camera", kCarried);
  EXPECT_EQ(refused_field(inbox, image(Format::kBgr8, 96)), "pose");
  EXPECT_EQ(refused_field(inbox, image(Format::kDepth16Mm, 64)), "pose");
  Pose pose;
  pose.position = {1, 2, 3};
  EXPECT_TRUE(inbox.add(posed(Format::kBgr8, kNow, pose)));
  EXPECT_EQ(inbox.wait(0)->picture.pose, pose);
}

TEST(ImageInbox, APoseThatCannotBeRightChangesNothing) {
  ImageInbox inbox("", "camera", kCarried);
  EXPECT_TRUE(inbox.add(posed(Format::kDepth16Mm, kNow)));
  EXPECT_TRUE(inbox.add(posed(Format::kBgr8, kNow)));
  Pose nowhere, turned, unsure;
  nowhere.position[2] = std::numeric_limits<double>::quiet_NaN();
  turned.orientation = {0, 0, 0, 0};
  unsure.covariance[0] = -1;
  for (const Format format : {Format::kBgr8, Format::kDepth16Mm}) {
    EXPECT_EQ(refused_field(inbox, posed(format, kNow + 1, nowhere)), "pose.position");
    EXPECT_EQ(refused_field(inbox, posed(format, kNow + 1, turned)), "pose.orientation");
    EXPECT_EQ(refused_field(inbox, posed(format, kNow + 1, unsure)), "pose.covariance");
  }
  const auto picture = inbox.wait(0);
  ASSERT_TRUE(picture);
  EXPECT_EQ(picture->utime, kNow);
  EXPECT_EQ(picture->picture.pose, Pose{});
  EXPECT_FALSE(picture->picture.depth.empty());
}

TEST(ImageInbox, DepthFromAnotherPoseIsOfAnotherPicture) {
  ImageInbox inbox("", "camera", kCarried);
  Pose nearly, elsewhere, turned;
  nearly.position[0] = 0.9 * ImageInbox::kSamePlace;
  elsewhere.position[0] = 1.1 * ImageInbox::kSamePlace;
  turned.orientation = {std::cos(0.6 * ImageInbox::kSameDirection), 0, 0,
                        std::sin(0.6 * ImageInbox::kSameDirection)};
  EXPECT_TRUE(inbox.add(posed(Format::kDepth16Mm, kNow)));
  EXPECT_TRUE(inbox.add(posed(Format::kBgr8, kNow, nearly)));
  EXPECT_FALSE(inbox.wait(0)->picture.depth.empty());
  EXPECT_TRUE(inbox.add(posed(Format::kBgr8, kNow + 1, elsewhere)));
  EXPECT_TRUE(inbox.wait(0)->picture.depth.empty());
  EXPECT_TRUE(inbox.add(posed(Format::kBgr8, kNow + 2, turned)));
  EXPECT_TRUE(inbox.wait(0)->picture.depth.empty());
}

}  // namespace
}  // namespace anchord
