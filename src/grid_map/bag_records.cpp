#include "src/grid_map/bag_records.hpp"

#include <rosbag/stream.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <vector>

#include "src/core/error.hpp"
#include "src/core/quoted.hpp"

namespace desert_sim {

namespace {

const std::string first_line = "#ROSBAG V2.0\n";
constexpr char message_op = 2, bag_op = 3, index_op = 4, chunk_op = 5, chunk_info_op = 6, connection_op = 7;
constexpr std::uint32_t index_entry = 12;      // size of an entry [bytes]: a time and an offset in the chunk
constexpr std::uint32_t chunk_info_entry = 8;  // likewise: a connection and a number of messages
// What a chunk may unpack to: rosbag allocates what the chunk says, and bzip2 packs a gigabyte in a kilobyte.
constexpr std::uint64_t always_unpacked = std::uint64_t{64} << 20, unpacked_ratio = 100;

/// The number at a place in the bytes; 0 if they are too few.
template <class T = std::uint32_t>
T number(const std::string& bytes, std::size_t at = 0) {
  T value = 0;
  if (bytes.size() >= at + sizeof value) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

struct Record {
  char op = 0;
  std::map<std::string, std::string> fields;
  std::uint64_t begin = 0, data = 0, size = 0;  ///< places in the source, and the size of the data

  std::string field(const std::string& name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? "" : found->second;
  }
};

/// Records one after another, in a file or in memory.
class Records {
 public:
  /// Copies bytes from a place; returns how many.
  using Source = std::function<std::size_t(std::uint64_t from, char* to, std::size_t bytes)>;

  Records(Source source, std::uint64_t begin, std::uint64_t end)
      : source_(std::move(source)), at_(begin), end_(end) {}

  bool at_end() const { return at_ == end_; }
  /// The next record; stops behind it.
  Record next() {
    Record record;
    record.begin = at_;
    const std::string header = read(number(read(4)));
    for (std::size_t at = 0; at < header.size();) {
      const std::uint32_t size = number(header, at);
      if (at + 4 > header.size() || size > header.size() - at - 4) fail();
      const std::string field = header.substr(at + 4, size);
      const std::size_t name_size = field.find('=');
      if (name_size == std::string::npos) fail();
      record.fields[field.substr(0, name_size)] = field.substr(name_size + 1);
      at += 4 + size;
    }
    const std::string op = record.field("op");
    record.op = op.empty() ? 0 : op[0];
    record.size = number(read(4));
    record.data = at_;
    if (record.size > end_ - at_) fail();
    at_ += record.size;
    return record;
  }
  std::string data(const Record& record) const { return bytes(record.data, record.size); }
  [[noreturn]] void fail() const {
    throw ConfigError("is truncated or corrupt (at byte " + std::to_string(at_) + ")");
  }

 private:
  std::string bytes(std::uint64_t from, std::uint64_t size) const {
    std::string bytes(size, '\0');
    if (source_(from, bytes.data(), size) != size) fail();
    return bytes;
  }
  std::string read(std::uint64_t size) {
    if (size > end_ - at_) fail();
    std::string read = bytes(at_, size);
    at_ += size;
    return read;
  }

  const Source source_;
  std::uint64_t at_;
  const std::uint64_t end_;
};

/// The content of a compressed chunk, as large as the chunk says; zeros at its end if it is smaller.
std::string unpacked(std::string packed, std::uint32_t size, const std::string& compression) {
  const std::uint64_t most = std::max(always_unpacked, unpacked_ratio * packed.size());
  if (size > most)
    throw ConfigError("a chunk of " + std::to_string(packed.size()) + " bytes unpacks to " +
                      std::to_string(size) + " (allowed: at most " + std::to_string(most) +
                      "; rosbag decompress has no such limit)");
  std::string bytes(size, '\0');
  const auto unpack = [&](rosbag::Stream&& stream) {
    stream.decompress(reinterpret_cast<std::uint8_t*>(bytes.data()), size,
                      reinterpret_cast<std::uint8_t*>(packed.data()),
                      static_cast<unsigned int>(packed.size()));
  };
  if (compression == "bz2")
    unpack(rosbag::BZ2Stream(nullptr));
  else if (compression == "lz4")
    unpack(rosbag::LZ4Stream(nullptr));
  else
    throw ConfigError("has the unknown compression " + in_quotes(compression) + " (allowed: none, bz2, lz4)");
  return bytes;
}

class Bag {
 public:
  explicit Bag(const InputFile& file)
      : source_(
            [&file](std::uint64_t from, char* to, std::size_t bytes) { return file.read(from, to, bytes); }),
        end_(std::max<std::uint64_t>(file.size(), first_line.size())),
        records_(source_, first_line.size(), end_) {}

  void check() {
    std::string line(first_line.size(), '\0');
    source_(0, line.data(), line.size());
    if (line != first_line) throw ConfigError("is not a bag of version 2.0");
    while (!records_.at_end()) {
      const Record record = records_.next();
      if (record.begin == first_line.size()) check_bag_header(record);
      index_found_ |= record.begin == index_position_;
      if (record.op == chunk_op) check_chunk(record);
      if (record.op == index_op) check_index(record);
      if (record.op == chunk_info_op) check_chunk_info(record);
    }
    // The index of a bag without messages is empty, at the end of the file.
    if (index_position_ != 0 && index_position_ != end_ && !index_found_) records_.fail();
  }

 private:
  /// rosbag loads the plugin that an encrypted bag names, which asks the user's keys.
  void check_bag_header(const Record& header) {
    if (header.op != bag_op) records_.fail();
    const std::string encryptor = header.field("encryptor");
    if (!encryptor.empty() && encryptor != "rosbag/NoEncryptor")
      throw ConfigError("is encrypted by " + in_quotes(encryptor) + ", which is not supported");
    index_position_ = number<std::uint64_t>(header.field("index_pos"));  // 0 while it is being recorded
  }

  /// Finds the messages of a chunk.
  void check_chunk(const Record& chunk) {
    chunks_.push_back(chunk.begin);
    messages_.clear();
    const std::string compression = chunk.field("compression");
    if (compression == "none")
      return find_messages({source_, chunk.data, chunk.data + chunk.size}, chunk.data);
    const std::string bytes = unpacked(records_.data(chunk), number(chunk.field("size")), compression);
    const auto copy = [&bytes](std::uint64_t from, char* to, std::size_t size) {
      return bytes.copy(to, size, from);
    };
    find_messages({copy, 0, bytes.size()}, 0);
  }
  void find_messages(Records records, std::uint64_t begin) {
    while (!records.at_end()) {
      const Record record = records.next();
      if (record.op == message_op)
        messages_.push_back(record.begin - begin);
      else if (record.op != connection_op)
        records_.fail();
    }
  }

  /// Checks that the entries of an index point to messages of the chunk before it.
  void check_index(const Record& index) const {
    if (std::uint64_t{number(index.field("count"))} * index_entry != index.size) records_.fail();
    const std::string entries = records_.data(index);
    for (std::size_t at = 0; at < entries.size(); at += index_entry)
      if (!std::binary_search(messages_.begin(), messages_.end(), number(entries, at + 8))) records_.fail();
  }

  /// Checks that a chunk is where its description says, and that the next record is behind the description.
  void check_chunk_info(const Record& info) const {
    const auto position = number<std::uint64_t>(info.field("chunk_pos"));
    const bool complete = std::uint64_t{number(info.field("count"))} * chunk_info_entry == info.size;
    if (!complete || !std::binary_search(chunks_.begin(), chunks_.end(), position)) records_.fail();
  }

  const Records::Source source_;
  const std::uint64_t end_;
  Records records_;
  std::uint64_t index_position_ = 0;
  bool index_found_ = false;             ///< whether a record begins at index_position_
  std::vector<std::uint64_t> chunks_;    ///< places of the chunks so far
  std::vector<std::uint64_t> messages_;  ///< places of the messages in the last chunk
};

}  // namespace

void validate_bag_records(const InputFile& file) { Bag(file).check(); }

}  // namespace desert_sim
