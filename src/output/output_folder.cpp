#include "osculate/output/output_folder.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/printable.hpp"
#include "output/manifest.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace osculate::output {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view manifest_name = OutputFolder::manifest;

[[noreturn]] void refuse(const fs::path& at, std::string expected, std::string found) {
    throw SceneError({{printable(at.string()), 0, 0, "", std::move(expected), std::move(found), ""}});
}

[[noreturn]] void fail(const char* what, const fs::path& path, int reason) {
    throw RunFailure(fmt::format("cannot {} {}: {}", what, path.string(),
                                 std::error_code(reason, std::generic_category()).message()));
}

bool is_there(const fs::path& path) {
    std::error_code none;
    return fs::exists(fs::symlink_status(path, none));
}

/// What a process left that was killed as it wrote a manifest.
bool is_part_of_manifest(const std::string& name) {
    return name.starts_with(std::string(manifest_name) + ".") && name.ends_with(".part");
}

/// What is in a folder without a manifest, but for folders that have one or are empty; sorted.
std::vector<std::string> strangers(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
        const std::string name = entry.path().filename();
        const bool is_folder = fs::is_directory(entry.symlink_status(none));
        if (is_folder && (OutputFolder::has_manifest(entry.path()) || strangers(entry.path()).empty())) continue;
        if (!is_folder && is_part_of_manifest(name)) continue;
        names.push_back("'" + printable(name) + (is_folder ? "/'" : "'"));
    }
    std::ranges::sort(names);
    return names;
}

/// "'a', 'b', 'c' and 7 more"
std::string some_of(const std::vector<std::string>& names) {
    constexpr std::size_t few = 4;
    const std::vector<std::string> first(names.begin(), names.begin() + static_cast<long>(std::min(few, names.size())));
    const std::string text = fmt::format("{}", fmt::join(first, ", "));
    return names.size() > few ? fmt::format("{} and {} more", text, names.size() - few) : text;
}

/// Files below a folder, relative to it; none of folders that have a manifest of their own or are links.
void list_files(const fs::path& folder, const std::string& prefix, std::vector<std::string>& files) {
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
        const std::string name = prefix + entry.path().filename().string();
        if (!fs::is_directory(entry.symlink_status(none)))
            files.push_back(name);
        else if (!OutputFolder::has_manifest(entry.path()))
            list_files(entry.path(), name + "/", files);
    }
}

/// Whether a name is one of the pattern's, in which `*` stands for one digit or more and comes before no digit.
bool fits(std::string_view name, std::string_view pattern) {
    const std::size_t star = pattern.find('*');
    if (star == std::string_view::npos) return name == pattern;
    if (!name.starts_with(pattern.substr(0, star))) return false;
    name.remove_prefix(star);
    const auto end = std::ranges::find_if_not(name, [](unsigned char c) { return std::isdigit(c) != 0; });
    const auto digits = static_cast<std::size_t>(end - name.begin());
    return digits > 0 && fits(name.substr(digits), pattern.substr(star + 1));
}

/// The first folder on the way to a file that is a symbolic link; empty: none is.
fs::path link_before(const fs::path& directory, const std::string& file) {
    std::error_code none;
    fs::path way = directory;
    for (const fs::path& part : fs::path(file).parent_path())
        if (fs::is_symlink(way /= part, none)) return way;
    return {};
}

void remove_file(const fs::path& path) {
    std::error_code error;
    if (fs::is_directory(fs::symlink_status(path, error))) return; // never a folder of someone
    fs::remove(path, error);
    if (error && error != std::errc::no_such_file_or_directory && error != std::errc::not_a_directory)
        fail("remove", path, error.value());
}

std::string part_of(const std::string& file) {
    return file + ".part";
}

} // namespace

OutputFolder::OutputFolder(fs::path directory, Entry entry, const std::vector<std::string>& wanted)
    : directory_(std::move(directory)), forced_(entry == Entry::force), locks_(entry != Entry::beside) {
    const bool known = has_manifest(directory_);
    if (!known && entry == Entry::beside) forced_ = true;
    if (!known && entry == Entry::careful) refuse_strangers();
    std::error_code error;
    fs::create_directories(directory_, error);
    if (error) fail("write", directory_, error.value());
    try {
        lock();
        read_manifest();
        if (entry == Entry::adopt) adopt(wanted);
        if (entry == Entry::careful) refuse_overwriting(wanted);
        if (locks_) write_manifest(); // it names this process now
    } catch (...) {
        if (file_ >= 0) close(file_);
        throw;
    }
}

OutputFolder::~OutputFolder() {
    close(file_);
}

bool OutputFolder::has_manifest(const fs::path& directory) {
    try {
        return output::read_manifest(directory / manifest).has_value();
    } catch (const SceneError&) { // it is one, and will be refused
        return true;
    }
}

void OutputFolder::refuse_strangers() const {
    std::error_code none;
    if (!fs::is_directory(directory_, none)) return; // absent, or a file, which cannot be written into
    if (const std::vector<std::string> names = strangers(directory_); !names.empty())
        refuse(directory_, fmt::format("a folder that is absent, is empty or holds the {} of an earlier run", manifest),
               fmt::format("{}; -o names another folder, --new takes {}-2 or the next one that is free, --force writes "
                           "into this folder and deletes nothing that osculate did not write",
                           some_of(names), printable(directory_.lexically_normal().string())));
}

/// Files that are there, fit one of the patterns and are not in the list; sorted.
std::vector<std::string> OutputFolder::unlisted(const std::vector<std::string>& patterns) const {
    std::vector<std::string> found;
    list_files(directory_, "", found);
    std::erase_if(found, [&](const std::string& file) {
        return files_.contains(file) ||
               std::ranges::none_of(patterns, [&](const std::string& pattern) { return fits(file, pattern); });
    });
    std::ranges::sort(found);
    return found;
}

void OutputFolder::refuse_overwriting(const std::vector<std::string>& wanted) const {
    std::vector<std::string> names;
    for (const std::string& file : unlisted(wanted)) names.push_back("'" + printable(file) + "'");
    if (!names.empty())
        refuse(directory_,
               fmt::format("no file with a name that osculate will write, except those listed in its {}", manifest),
               fmt::format("{}; -o names another folder, --new takes the next one that is free, --force overwrites",
                           some_of(names)));
}

/// Opens the manifest, made when missing, and locks it: the file that has the name now, not one that has just been replaced.
void OutputFolder::lock() {
    const fs::path path = directory_ / manifest;
    while (true) {
        file_ = open(path.c_str(), O_RDWR | O_APPEND | O_CLOEXEC | O_NOFOLLOW);
        if (file_ < 0 && errno == ENOENT) {
            if (make_manifest()) return;
            continue; // another process was first
        }
        if (file_ < 0) fail("write", path, errno);
        if (!locks_) return;
        if (flock(file_, LOCK_EX | LOCK_NB) != 0) {
            if (errno == EWOULDBLOCK) {
                const auto theirs = output::read_manifest(path);
                refuse(directory_, "a folder that no other process of osculate writes into",
                       theirs
                           ? fmt::format("process {} at work in it; -o names another folder, --new takes the next one "
                                         "that is free",
                                         theirs->process)
                           : "another process at work in it");
            }
            fmt::print(stderr, "{} cannot be locked on this file system: make sure that no second run writes into it\n",
                       directory_.string());
        }
        struct stat mine {
        }, there{};
        if (fstat(file_, &mine) == 0 && stat(path.c_str(), &there) == 0 && mine.st_ino == there.st_ino &&
            mine.st_dev == there.st_dev)
            return;
        close(file_);
    }
}

void OutputFolder::read_manifest() {
    if (auto read = output::read_manifest(directory_ / manifest)) files_ = std::move(read->files);
}

namespace {

/// A new manifest beside the one there is: its path, and the file, locked.
std::pair<fs::path, int> write_aside(const fs::path& directory, const std::set<std::string>& files) {
    const fs::path part = directory / fmt::format("{}.{}.part", manifest_name, getpid());
    const int file = open(part.c_str(), O_RDWR | O_APPEND | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file < 0) fail("write", directory / manifest_name, errno);
    (void)flock(file, LOCK_EX | LOCK_NB); // where a file system has no locks, lock() has said so
    const std::string text = text_of({getpid(), files});
    if (const ssize_t written = write(file, text.data(), text.size()); written != static_cast<ssize_t>(text.size())) {
        const int reason = written < 0 ? errno : ENOSPC;
        close(file);
        unlink(part.c_str());
        fail("write", directory / manifest_name, reason);
    }
    return {part, file};
}

} // namespace

/// @returns  whether this process made it, and not another one meanwhile
bool OutputFolder::make_manifest() {
    const auto [part, file] = write_aside(directory_, files_);
    const fs::path path = directory_ / manifest;
    int failed = link(part.c_str(), path.c_str()) == 0 ? 0 : errno;
    if (failed == EPERM || failed == EOPNOTSUPP || failed == ENOSYS) // file systems without second names
        failed = rename(part.c_str(), path.c_str()) == 0 ? 0 : errno;
    else
        unlink(part.c_str());
    if (failed != 0) close(file);
    if (failed != 0 && failed != EEXIST) fail("write", path, failed);
    if (failed == 0) file_ = file;
    return failed == 0;
}

void OutputFolder::write_manifest() {
    const auto [part, file] = write_aside(directory_, files_);
    const fs::path path = directory_ / manifest;
    if (rename(part.c_str(), path.c_str()) != 0) {
        const int reason = errno;
        close(file);
        unlink(part.c_str());
        fail("write", path, reason);
    }
    close(file_); // locked until the new one, which is locked, has its name
    file_ = file;
}

void OutputFolder::append(const std::vector<std::string>& files) {
    const std::string text = fmt::format("{}\n", fmt::join(files, "\n"));
    struct stat before {};
    if (fstat(file_, &before) != 0) fail("write", directory_ / manifest, errno);
    const ssize_t written = write(file_, text.data(), text.size());
    if (written == static_cast<ssize_t>(text.size())) return;
    const int reason = written < 0 ? errno : ENOSPC;
    if (written > 0) (void)!ftruncate(file_, before.st_size); // half a line would spoil the next one
    fail("write", directory_ / manifest, reason);
}

void OutputFolder::claim(const std::vector<std::string>& files) {
    std::vector<std::string> fresh;
    for (const std::string& file : files)
        if (!files_.contains(file)) fresh.push_back(file);
    if (fresh.empty()) return;
    for (const std::string& file : fresh) {
        std::error_code none;
        const fs::path path = directory_ / file;
        if (!is_there(path) || (forced_ && !fs::is_symlink(path, none))) continue;
        const auto now = output::read_manifest(directory_ / manifest); // `osculate report` lists its own
        if (!now || !now->files.contains(file))
            throw RunFailure("cannot write " + path.string() + ": it is there, and osculate did not write it");
    }
    append(fresh);
    files_.insert(fresh.begin(), fresh.end());
}

fs::path OutputFolder::path_of(const std::string& file) {
    claim({file});
    return directory_ / file;
}

void OutputFolder::adopt(const std::vector<std::string>& wanted) {
    if (wanted.empty() || files_.contains(wanted.front())) return;
    const std::vector<std::string> found = unlisted(wanted);
    if (found.empty()) return;
    append(found);
    files_.insert(found.begin(), found.end());
}

void OutputFolder::remove_all_but(const std::set<std::string>& kept) {
    read_manifest(); // with what `osculate report` has added
    std::set<std::string> left;
    std::vector<std::string> old;
    for (const std::string& file : files_) {
        const bool stays = kept.contains(file);
        if (stays) left.insert(file);
        old.push_back(stays ? part_of(file) : file);
        if (!stays) old.push_back(part_of(file));
    }
    std::error_code unread;
    // their processes are gone: the folder is locked
    for (const auto& entry : fs::directory_iterator(directory_, unread))
        if (const std::string name = entry.path().filename(); is_part_of_manifest(name)) old.push_back(name);
    for (const std::string& file : old)
        if (const fs::path link = link_before(directory_, file); !link.empty() && is_there(directory_ / file))
            refuse(link, "a folder, as the files in it are to be removed", "a symbolic link");
    // lists such as series.pvd before what they list
    std::stable_partition(old.begin(), old.end(),
                          [](const std::string& file) { return file.find('/') == std::string::npos; });
    std::set<fs::path> folders;
    for (const std::string& file : old) {
        remove_file(directory_ / file);
        for (fs::path folder = fs::path(file).parent_path(); !folder.empty(); folder = folder.parent_path())
            folders.insert(folder);
    }
    std::error_code none; // a folder that is not empty stays
    for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder)
        if (!fs::is_symlink(directory_ / *folder, none)) rmdir((directory_ / *folder).c_str());
    files_ = std::move(left);
    write_manifest();
}

void OutputFolder::remove_everything() {
    remove_all_but({});
    remove_file(directory_ / manifest);
    rmdir(directory_.c_str());
}

fs::path OutputFolder::numbered(fs::path directory) {
    if (!directory.has_filename()) directory = directory.parent_path();
    std::error_code error;
    if (directory.has_parent_path()) fs::create_directories(directory.parent_path(), error);
    if (error) fail("write", directory, error.value());
    for (int number = 1;; ++number) {
        fs::path one = directory;
        if (number > 1) one += fmt::format("-{}", number);
        if (mkdir(one.c_str(), 0777) == 0) return one;
        if (errno != EEXIST) fail("write", one, errno);
        if (fs::is_directory(one, error) && fs::is_empty(one, error)) return one;
    }
}

} // namespace osculate::output
