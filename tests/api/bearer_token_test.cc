#include "api/bearer_token.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>

#include "tests/daemon/scene.h"

namespace anchord {
namespace {

constexpr char kToken[] = "0123456789abcdef~!";

class TokenFile : public ::testing::Test {
 protected:
  std::string write(const std::string& text, mode_t mode = 0600) {
    const auto file = folder_.write("token", text);
    chmod(file.c_str(), mode);
    return file;
  }
  /// The refusal names the file, says `word`, and does not repeat what was in it.
  void refuses(const std::string& file, const std::string& word) {
    const auto token = BearerToken::read(file);
    ASSERT_FALSE(token.ok()) << word;
    EXPECT_EQ(token.error().code, ErrorCode::kInvalid);
    EXPECT_EQ(token.error().field, file);
    EXPECT_NE(token.error().message.find(word), std::string::npos) << token.error().text();
    EXPECT_EQ(token.error().text().find("89abc"), std::string::npos);
  }

  TestFolder folder_;
};

TEST_F(TokenFile, OneNewlineAtItsEndIsNotTheTokens) {
  for (const char* end : {"", "\n"}) {
    const auto token = BearerToken::read(write(std::string(kToken) + end));
    ASSERT_TRUE(token.ok()) << token.error().text();
    EXPECT_TRUE(token->admits(std::string("Bearer ") + kToken));
    EXPECT_EQ(token->authorization(), std::string("Bearer ") + kToken);
  }
  EXPECT_TRUE(BearerToken::read(write(kToken, 0400)).ok());
}

TEST_F(TokenFile, MustBeReadByItsOwnerAlone) {
  for (const mode_t mode : {0640, 0604, 0660, 0644, 0610, 0602})
    refuses(write(kToken, mode), "chmod 600");
}

TEST_F(TokenFile, MayBeACredentialThatSystemdPasses) {
  const auto file = write(kToken, 0440);
  setenv("CREDENTIALS_DIRECTORY", (folder_ / "").c_str(), 1);
  refuses(file, "chmod 600");  // "FOLDER/" + "/": not that directory's
  const std::string directory = file.substr(0, file.rfind('/'));
  setenv("CREDENTIALS_DIRECTORY", directory.c_str(), 1);
  EXPECT_TRUE(BearerToken::read(file).ok());
  refuses(write(kToken, 0444), "chmod 600");
  write(kToken, 0440);
  refuses(directory + "/../" + directory.substr(directory.rfind('/') + 1) + "/token", "chmod 600");
  unsetenv("CREDENTIALS_DIRECTORY");
}

TEST_F(TokenFile, HoldsOneWordOfASensibleLength) {
  refuses(write(""), "16 to 256");
  refuses(write("0123456789abcde\n"), "16 to 256");
  refuses(write(std::string(257, 'x')), "16 to 256");
  refuses(write(std::string(1'000'000, 'x')), "16 to 256");
  EXPECT_TRUE(BearerToken::read(write(std::string(256, 'x') + "\n")).ok());
  EXPECT_TRUE(BearerToken::read(write(std::string(16, 'x'))).ok());
  for (const std::string& bad :
       {"0123456789 abcdef", "0123456789abcdef\n\n", "0123456789abcdef\r\n", "0123456789\tabcdef",
        "0123456789\x7f"
        "abcdef",
        "0123456789äbcdef"})
    refuses(write(bad), "printable");
  refuses(write(std::string("0123456789\0abcdef", 17)), "printable");
}

TEST_F(TokenFile, MustBeARegularFile) {
  refuses(folder_ / "none", "cannot be read");
  const auto directory = folder_ / "directory";
  std::filesystem::create_directory(directory);
  refuses(directory, "regular file");
  ASSERT_EQ(mkfifo((folder_ / "fifo").c_str(), 0600), 0);
  refuses(folder_ / "fifo", "regular file");
  refuses("/dev/zero", "regular file");
}

TEST(BearerToken, AdmitsItselfAlone) {
  const auto token = BearerToken::parse(kToken);
  ASSERT_TRUE(token.ok());
  const std::string right = std::string("Bearer ") + kToken;
  EXPECT_TRUE(token->admits(right));
  EXPECT_TRUE(token->admits(std::string("bEARER   ") + kToken));
  // Every bit of every character counts, and so does the length.
  for (std::size_t i = 7; i < right.size(); ++i)
    for (int bit = 0; bit < 8; ++bit) {
      std::string other = right;
      other[i] = static_cast<char>(other[i] ^ (1 << bit));
      EXPECT_FALSE(token->admits(other)) << other;
    }
  for (std::size_t size = 0; size < right.size(); ++size)
    EXPECT_FALSE(token->admits(right.substr(0, size)));
  for (const std::string& end : {std::string("x"), std::string(" "), std::string(1, '\0'),
                                 std::string(238, '\0'), std::string(10'000, 'x')})
    EXPECT_FALSE(token->admits(right + end));
  for (const std::string& other :
       {std::string("Basic "), std::string("Bearer"), std::string("Bearer\t"),
        std::string("Bearer Bearer "), std::string(), std::string("\"")})
    EXPECT_FALSE(token->admits(other + kToken)) << other;
}

TEST(BearerToken, OfTheGreatestLengthIsComparedWhole) {
  const auto token = BearerToken::parse(std::string(256, 'x'));
  ASSERT_TRUE(token.ok());
  EXPECT_TRUE(token->admits("Bearer " + std::string(256, 'x')));
  EXPECT_FALSE(token->admits("Bearer " + std::string(255, 'x')));
  EXPECT_FALSE(token->admits("Bearer " + std::string(255, 'x') + "y"));
  EXPECT_FALSE(token->admits("Bearer " + std::string(257, 'x')));
  EXPECT_EQ(token->authorization(), "Bearer " + std::string(256, 'x'));
}

}  // namespace
}  // namespace anchord
