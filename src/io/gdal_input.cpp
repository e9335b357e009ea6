#include "src/io/gdal_input.hpp"

#include <cpl_vsi.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <mutex>

#include "src/core/error.hpp"
#include "src/core/log.hpp"

namespace desert_sim {

namespace fs = std::filesystem;

namespace {

constexpr const char* file_system = "/vsidesert_sim/";

/// The files of all GdalInput, by what follows the prefix in their names.
std::mutex open_files_mutex;
std::map<std::string, std::shared_ptr<const InputFile>> open_files;
unsigned long inputs = 0;

std::shared_ptr<const InputFile> find_file(const char* name) {
  const std::lock_guard<std::mutex> lock(open_files_mutex);
  const auto found = open_files.find(name);
  return found == open_files.end() ? nullptr : found->second;
}

struct Handle {
  std::shared_ptr<const InputFile> file;
  vsi_l_offset at = 0;
  bool at_end = false;
};

int on_stat(void*, const char* name, VSIStatBufL* status, int) {
  const auto file = find_file(name);
  if (!file) return -1;
  std::memset(status, 0, sizeof *status);
  status->st_mode = S_IFREG | S_IRUSR;
  status->st_size = static_cast<decltype(status->st_size)>(file->size());
  return 0;
}

void* on_open(void*, const char* name, const char* access) {
  const bool writes = std::strpbrk(access, "wa+") != nullptr;
  auto file = writes ? nullptr : find_file(name);
  if (!file) {
    errno = writes ? EROFS : ENOENT;
    return nullptr;
  }
  return new Handle{std::move(file)};
}

vsi_l_offset on_tell(void* handle) { return static_cast<Handle*>(handle)->at; }

int on_seek(void* handle, vsi_l_offset offset, int whence) {
  Handle& h = *static_cast<Handle*>(handle);
  h.at = offset + (whence == SEEK_CUR ? h.at : (whence == SEEK_END ? h.file->size() : 0));
  h.at_end = false;
  return 0;
}

size_t on_read(void* handle, void* to, size_t size, size_t count) {
  Handle& h = *static_cast<Handle*>(handle);
  if (size == 0 || count == 0) return 0;
  try {
    const size_t bytes = h.file->read(h.at, to, size * count);
    h.at += bytes;
    h.at_end = bytes < size * count;
    return bytes / size;
  } catch (const ConfigError& e) {
    log_error(e.what());  // GDAL reports a short read without the reason
    return 0;
  }
}

int on_eof(void* handle) { return static_cast<Handle*>(handle)->at_end ? 1 : 0; }

int on_close(void* handle) {
  delete static_cast<Handle*>(handle);
  return 0;
}

void install_file_system() {
  static std::once_flag once;
  std::call_once(once, [] {
    VSIFilesystemPluginCallbacksStruct* callbacks = VSIAllocFilesystemPluginCallbacksStruct();
    callbacks->stat = on_stat;
    callbacks->open = on_open;
    callbacks->tell = on_tell;
    callbacks->seek = on_seek;
    callbacks->read = on_read;
    callbacks->eof = on_eof;
    callbacks->close = on_close;
    callbacks->nBufferSize = 1 << 16;
    callbacks->nCacheSize = 1 << 20;
    VSIInstallPluginHandler(file_system, callbacks);
    VSIFreeFilesystemPluginCallbacksStruct(callbacks);
  });
}

/// Names that the companions of a raster may have, in lower case.
std::vector<std::string> companion_names(const fs::path& path) {
  const std::string name = path.filename().string();
  std::vector<std::string> names{name + ".hdr", name + ".msk"};
  for (const char* extension : {".hdr", ".prj", ".tfw", ".tifw", ".tiffw", ".pgw", ".pngw", ".wld"})
    names.push_back(path.stem().string() + extension);
  return names;
}

/// The companion's name with its extension in upper case.
std::string upper_case_extension(const std::string& name) {
  std::string upper = name;
  for (std::size_t i = name.rfind('.'); i < name.size(); ++i)
    upper[i] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[i])));
  return upper;
}

}  // namespace

GdalInput::GdalInput(const std::string& path, const std::string& folder)
    : base_name_(fs::path(path).filename().string()) {
  files_[base_name_] = std::make_shared<InputFile>(path, folder);
  const fs::path beside = fs::path(path).parent_path();
  const auto lies_there = [&beside](const std::string& name) {
    std::error_code error;
    return fs::symlink_status(beside / name, error).type() != fs::file_type::not_found && !error;
  };
  for (const std::string& lower : companion_names(path))
    for (const std::string& name : {lower, upper_case_extension(lower)})
      if (files_.count(name) == 0 && lies_there(name))
        files_[name] = std::make_shared<InputFile>((beside / name).string(), folder);
  if (lies_there(base_name_ + ".aux.xml")) unread_metadata_ = base_name_ + ".aux.xml";
  install_file_system();
  const std::lock_guard<std::mutex> lock(open_files_mutex);
  prefix_ = std::to_string(inputs++) + "/";
  for (const auto& [name, file] : files_) open_files[prefix_ + name] = file;
}

GdalInput::~GdalInput() {
  const std::lock_guard<std::mutex> lock(open_files_mutex);
  for (const auto& entry : files_) open_files.erase(prefix_ + entry.first);
}

std::string GdalInput::name() const { return file_system + prefix_ + base_name_; }

std::vector<std::string> GdalInput::siblings() const {
  std::vector<std::string> names;
  for (const auto& entry : files_) names.push_back(entry.first);
  return names;
}

}  // namespace desert_sim
