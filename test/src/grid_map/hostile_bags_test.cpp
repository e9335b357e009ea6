// Bags whose records are well formed but lie: about what a chunk unpacks to, about where things are, or
// that ask for more than reading. The rosbag library believes them.

#include <gtest/gtest.h>
#include <rosbag/bag.h>

#include <cstring>

#include "test/src/grid_map/maps.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim {
namespace {

constexpr std::uint32_t seconds = 10;                                   // ROS time of the message
constexpr std::size_t first_record = 13, first_record_size = 4096 + 8;  // behind the line with the version

class HostileBags : public testing::Test {
 protected:
  std::string packed_bag(rosbag::compression::CompressionType compression) const {
    {
      rosbag::Bag bag(path_, rosbag::bagmode::Write);
      bag.setCompression(compression);
      bag.write("/map", ros::Time(seconds), test::a_map());
    }
    return test::file_bytes(path_);
  }
  std::string plain_bag() const {
    write_grid_map(path_, "/map", test::a_map());
    return test::file_bytes(path_);
  }
  void expect_refused(const std::string& bytes, const std::string& reason) const {
    folder_.write("a.bag", bytes);
    try {
      read_grid_map(path_);
      ADD_FAILURE() << "was read";
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(reason), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(path_), std::string::npos) << e.what();
    }
  }

  const test::TemporaryFolder folder_;
  const std::string path_ = folder_.path("a.bag");
};

/// The place of the value of a field, in the first record that has it.
std::size_t value_of(const std::string& bag, const std::string& field) {
  const std::size_t at = bag.find(field + "=");
  EXPECT_NE(at, std::string::npos);
  return at + field.size() + 1;
}

std::uint32_t number_at(const std::string& bytes, std::size_t at) {
  std::uint32_t number;
  std::memcpy(&number, &bytes.at(at), sizeof number);
  return number;
}
std::string with_number(std::string bytes, std::size_t at, std::uint32_t number) {
  std::memcpy(&bytes.at(at), &number, sizeof number);
  return bytes;
}

TEST_F(HostileBags, ChunksThatUnpackToGigabytesAreRefusedBeforeThat) {
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string bag = packed_bag(compression);
    const std::size_t size = value_of(bag, "size");
    EXPECT_EQ(read_grid_map(path_).layers.size(), 1u);
    expect_refused(with_number(bag, size, 0xffffffffu), "unpacks to 4294967295 (allowed: at most 67108864;");
    expect_refused(with_number(bag, size, (64u << 20) + 1), "unpacks to 67108865 (allowed:");
  }
}

TEST_F(HostileBags, ChunksThatUnpackToAnotherSizeThanTheySayAreRefused) {
  for (const auto compression : {rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string bag = packed_bag(compression);
    const std::size_t size = value_of(bag, "size");
    const std::uint32_t right = number_at(bag, size);
    for (const std::uint32_t wrong :
         {0u, 1u, right - 1, right + 1, right + 7, right + 8, right + 1000, 64u << 20})
      expect_refused(with_number(bag, size, wrong), "is ");
  }
}

TEST_F(HostileBags, UnknownCompressionsAreRefused) {
  std::string bag = packed_bag(rosbag::compression::BZ2);
  bag.replace(value_of(bag, "compression"), 3, "xyz");
  expect_refused(bag, "unknown compression 'xyz'");
}

/// The library takes what lies there for the lengths of a message, also of what is no message.
TEST_F(HostileBags, IndexesOfOtherPlacesThanMessagesAreRefused) {
  for (const auto compression :
       {rosbag::compression::Uncompressed, rosbag::compression::BZ2, rosbag::compression::LZ4}) {
    const std::string bag = packed_bag(compression);
    // An index of one message has 12 bytes: its time, and its place in the chunk.
    const std::string time = with_number(with_number(std::string(8, '\0'), 0, seconds), 4, 0);
    const std::size_t index = bag.find(with_number("    ", 0, 12) + time);
    ASSERT_NE(index, std::string::npos);
    const std::size_t at = index + 4 + time.size();
    const std::uint32_t place = number_at(bag, at);
    for (const std::uint32_t wrong : {0u, place + 1, place + 30, 0x7fffffffu, 0xfffffff0u})
      expect_refused(with_number(bag, at, wrong), "is truncated or corrupt");
  }
}

TEST_F(HostileBags, ChunksAndIndexesInThePlaceOfOthersAreRefused) {
  const std::string bag = plain_bag();
  for (const char* field : {"chunk_pos", "index_pos"}) {
    const std::size_t at = value_of(bag, field);
    for (const std::uint32_t wrong : {number_at(bag, at) + 1, 13u, 4117u + 40, 0xffffffffu})
      expect_refused(with_number(bag, at, wrong), "is truncated or corrupt");
  }
}

/// The library would load a plugin that looks for the user's keys.
TEST_F(HostileBags, EncryptedOnesAreRefused) {
  for (const std::string& encryptor : {std::string("rosbag/AesCbcEncryptor"), std::string("other/Plugin")}) {
    std::string bag = plain_bag();
    const std::uint32_t header = number_at(bag, first_record);
    const std::string text = "encryptor=" + encryptor,
                      field = with_number("    ", 0, static_cast<std::uint32_t>(text.size())) + text;
    const std::size_t data = first_record + 4 + header;
    bag = with_number(bag, data, number_at(bag, data) - static_cast<std::uint32_t>(field.size()));
    bag = with_number(bag, first_record, header + static_cast<std::uint32_t>(field.size()));
    bag.erase(first_record + first_record_size - field.size(), field.size());
    bag.insert(data, field);
    expect_refused(bag, "is encrypted by '" + encryptor + "'");
  }
}

}  // namespace
}  // namespace desert_sim
