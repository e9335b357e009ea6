#include "src/grid_map/bag_records.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <set>

#include "src/core/error.hpp"

namespace desert_sim {

namespace {

const std::string first_line = "#ROSBAG V2.0\n";
constexpr char chunk_op = 5, index_op = 4;
constexpr std::uint32_t index_entry = 12;  // size of an entry [bytes]: a time and an offset in the chunk

std::uint32_t number(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  if (bytes.size() >= at + sizeof value) std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

class Bag {
 public:
  explicit Bag(const InputFile& file) : file_(file.descriptor_path(), std::ios::binary), end_(file.size()) {}

  void check() {
    if (read(end_, first_line.size()) != first_line) throw ConfigError("is not a bag of version 2.0");
    while (at_ < end_) {
      const Record record = read_record_header(end_);
      if (record.op == chunk_op) check_chunk(record);
      if (record.op == index_op) check_index(record);
      seek(record.data + record.size);
    }
  }

 private:
  struct Record {
    char op = 0;
    std::map<std::string, std::string> fields;
    std::uint64_t data = 0, size = 0;
  };

  [[noreturn]] void fail() const {
    throw ConfigError("is truncated or corrupt (at byte " + std::to_string(at_) + ")");
  }
  void seek(std::uint64_t place) { file_.seekg(static_cast<std::streamoff>(at_ = place)); }

  std::string read(std::uint64_t end, std::uint64_t size) {
    if (size > end - at_) fail();
    std::string bytes(size, '\0');
    if (!file_.read(bytes.data(), static_cast<std::streamsize>(size))) fail();
    at_ += size;
    return bytes;
  }

  /// Reads the header of the record at the present position and stops at the beginning of its data.
  Record read_record_header(std::uint64_t end) {
    Record record;
    const std::string header = read(end, number(read(end, 4), 0));
    for (std::size_t at = 0; at < header.size();) {
      const std::uint32_t size = number(header, at);
      if (at + 4 > header.size() || size > header.size() - at - 4) fail();
      const std::string field = header.substr(at + 4, size);
      record.fields[field.substr(0, field.find('='))] =
          field.substr(std::min(field.size(), field.find('=') + 1));
      at += 4 + size;
    }
    record.op = record.fields["op"].empty() ? 0 : record.fields["op"][0];
    record.size = number(read(end, 4), 0);
    record.data = at_;
    if (record.size > end - at_) fail();
    return record;
  }

  void check_chunk(const Record& chunk) {
    const auto compression = chunk.fields.find("compression");
    uncompressed_ = compression != chunk.fields.end() && compression->second == "none";
    records_.clear();
    while (uncompressed_ && at_ < chunk.data + chunk.size) {
      records_.insert(at_ - chunk.data);
      const Record record = read_record_header(chunk.data + chunk.size);
      seek(record.data + record.size);
    }
  }

  /// Checks that the entries of an index point to records of the chunk before it.
  void check_index(Record index) {
    if (std::uint64_t{number(index.fields["count"], 0)} * index_entry != index.size) fail();
    const std::string entries = read(end_, index.size);
    for (std::size_t at = 0; uncompressed_ && at < entries.size(); at += index_entry)
      if (records_.count(number(entries, at + 8)) == 0) fail();
  }

  std::ifstream file_;
  const std::uint64_t end_;
  std::uint64_t at_ = 0;
  bool uncompressed_ = false;        ///< whether the last chunk is uncompressed
  std::set<std::uint64_t> records_;  ///< offsets of its records, if it is uncompressed
};

}  // namespace

void validate_bag_records(const InputFile& file) { Bag(file).check(); }

}  // namespace desert_sim
