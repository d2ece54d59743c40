// SPDX-License-Identifier: Zlib
// Copyright (c) 2026 The BulletFEM authors
#include "tools/pictures/film_writer.h"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "fem/common/message.h"
#include "fem/common/output_file.h"

extern char** environ;

namespace bullet_fem
{
namespace
{

bool endsWith(const std::string& text, const std::string& end)
{
    return text.size() > end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Arguments of ffmpeg. No metadata and one thread: equal frames then give equal bytes.
std::vector<std::string> arguments(const PictureSize& size, int rate, const std::string& path, bool gif)
{
    std::vector<std::string> a{"ffmpeg",  "-hide_banner", "-loglevel", "error", "-y",
                               "-xerror",  // otherwise a full disk is only a warning
                               "-f",      "rawvideo",     "-pix_fmt",  "rgb24"};
    const auto add = [&](std::initializer_list<std::string> more) { a.insert(a.end(), more); };
    add({"-s", message(size.m_width, "x", size.m_height), "-r", std::to_string(rate), "-i", "pipe:0", "-an"});
    if (gif)  // one palette of 256 colours for the whole film
        add({"-vf", "split[a][b];[a]palettegen=stats_mode=full[p];[b][p]paletteuse=dither=bayer:bayer_scale=4", "-f",
             "gif"});
    else  // players support only even sizes in 4:2:0
        add({"-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white,format=yuv420p", "-c:v", "libx264", "-crf", "18",
             "-threads", "1", "-movflags", "+faststart", "-f", "mp4"});
    add({"-map_metadata", "-1", "-fflags", "+bitexact", "-flags:v", "+bitexact", "file:" + path});
    return a;
}

/// ffmpeg's standard error output.
std::string contents(std::FILE* file)
{
    std::string text(4096, '\0');
    std::rewind(file);
    text.resize(std::fread(&text[0], 1, text.size(), file));
    while (!text.empty() && text.back() == '\n') text.pop_back();
    return text.empty() ? "without a message" : text;
}

}  // namespace

/// The ffmpeg process, fed through a socket: there, writing after the reader has ended is an error, not a signal.
struct FilmWriter::Child
{
    OutputFile m_file;
    std::FILE* m_words = std::tmpfile();
    pid_t m_process = -1;
    int m_socket = -1;

    explicit Child(const std::string& path) : m_file(path) {}
    ~Child()
    {
        closeSocket();
        if (m_process > 0)
        {
            kill(m_process, SIGKILL);
            wait();
        }
        if (m_words) std::fclose(m_words);
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    void start(const std::vector<std::string>& words)
    {
        int ends[2];
        if (!m_words || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
            m_file.fail(std::strerror(errno));
        m_socket = ends[0];
        std::vector<char*> argv;
        for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
        argv.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
        posix_spawn_file_actions_adddup2(&actions, fileno(m_words), 1);
        posix_spawn_file_actions_adddup2(&actions, fileno(m_words), 2);
        const int error = posix_spawnp(&m_process, argv[0], &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
        if (error != 0)
        {
            m_process = -1;
            m_file.fail(std::string("the program ffmpeg cannot be started (") + std::strerror(error) +
                        "); install it (Debian: ffmpeg), or write PNG files");
        }
    }

    void closeSocket()
    {
        if (m_socket >= 0) close(m_socket);
        m_socket = -1;
    }

    /// Waits for the process; returns whether it succeeded.
    bool wait()
    {
        int status = 0;
        while (waitpid(m_process, &status, 0) < 0 && errno == EINTR)
        {
        }
        m_process = -1;
        return WIFEXITED(status) && WEXITSTATUS(status) == 0;
    }

    [[noreturn]] void fail() { m_file.fail("ffmpeg failed: " + contents(m_words)); }
};

FilmWriter::FilmWriter(const std::string& path, const PictureSize& size, int framesPerSecond) : m_size(size)
{
    const bool gif = endsWith(path, ".gif");
    if (!gif && !endsWith(path, ".mp4")) reject("film: the path is '", path, "'; it must end in .mp4 or .gif");
    if (framesPerSecond < 1 || framesPerSecond > 100)
        reject("film: the rate is ", framesPerSecond, " frames a second; it must be in [1, 100]");
    if (size.m_width <= 0 || size.m_height <= 0)
        reject("film: the size is ", size.m_width, " x ", size.m_height, " pixels; both must be > 0");
    m_child = std::make_unique<Child>(path);
    m_child->start(arguments(size, framesPerSecond, m_child->m_file.temporaryPath(), gif));
}

FilmWriter::~FilmWriter() = default;

void FilmWriter::append(const Image& frame)
{
    if (!m_child) reject("film: it is finished; nothing can be appended");
    if (frame.m_size.m_width != m_size.m_width || frame.m_size.m_height != m_size.m_height)
        reject("film: the frame is ", frame.m_size.m_width, " x ", frame.m_size.m_height, " pixels; it must be ",
               m_size.m_width, " x ", m_size.m_height, " like the film");
    const unsigned char* bytes = frame.m_pixels.data();
    for (std::size_t left = frame.m_pixels.size(); left > 0;)
    {
        const ssize_t sent = send(m_child->m_socket, bytes, left, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent < 0)
        {
            const std::unique_ptr<Child> child = std::move(m_child);
            child->closeSocket();
            child->wait();
            child->fail();
        }
        bytes += sent;
        left -= static_cast<std::size_t>(sent);
    }
    ++m_frames;
}

void FilmWriter::finish()
{
    if (m_frames == 0 || !m_child) reject("film: it has no frames, or is finished already; append frames first");
    const std::unique_ptr<Child> child = std::move(m_child);
    child->closeSocket();
    if (!child->wait()) child->fail();
    child->m_file.commit();
}

bool FilmWriter::available()
{
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((folder + "/ffmpeg").c_str(), X_OK) == 0) return true;
    return false;
}

}  // namespace bullet_fem
