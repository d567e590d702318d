/* OpenVDB archives in memory. File::write() does not notice a full disk and puts random bytes into each archive. Here the archive goes to
 * a growing buffer, and its UUID is made from the file's identity and a hash of its content. */
#include "vdb/shim.hpp"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/util/logging.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <ostream>
#include <streambuf>

extern "C" {
#include "base/hash.h"
}

namespace
{
/* A stream into memory that can seek back, as the archive does to fill in grid offsets. */
class memory_sink : public std::streambuf
{
  public:
    memory_sink() = default;
    memory_sink(const memory_sink &) = delete;
    memory_sink &operator=(const memory_sink &) = delete;
    ~memory_sink() override
    {
        std::free(data_);
    }
    char *data()
    {
        return data_;
    }
    size_t size() const
    {
        return size_;
    }
    void *release()
    {
        void *shrunk = std::realloc(data_, size_ ? size_ : 1);
        void *p = shrunk ? shrunk : data_;
        data_ = nullptr;
        return p;
    }

  protected:
    std::streamsize xsputn(const char *bytes, std::streamsize n) override
    {
        const size_t end = at_ + static_cast<size_t>(n);
        if (end > capacity_) {
            size_t grown = capacity_ ? capacity_ : size_t(1) << 20;
            while (grown < end)
                grown *= 2;
            void *p = std::realloc(data_, grown);
            if (!p)
                throw std::bad_alloc();
            data_ = static_cast<char *>(p);
            capacity_ = grown;
        }
        if (at_ > size_)
            std::memset(data_ + size_, 0, at_ - size_);
        std::memcpy(data_ + at_, bytes, static_cast<size_t>(n));
        at_ = end;
        if (end > size_)
            size_ = end;
        return n;
    }
    int_type overflow(int_type c) override
    {
        const char byte = traits_type::to_char_type(c);
        xsputn(&byte, 1);
        return c;
    }
    pos_type seekoff(off_type off, std::ios_base::seekdir way, std::ios_base::openmode) override
    {
        const off_type base = way == std::ios_base::beg   ? 0
                              : way == std::ios_base::cur ? static_cast<off_type>(at_)
                                                          : static_cast<off_type>(size_);
        if (base + off < 0)
            return pos_type(off_type(-1));
        at_ = static_cast<size_t>(base + off);
        return pos_type(base + off);
    }
    pos_type seekpos(pos_type pos, std::ios_base::openmode which) override
    {
        return seekoff(off_type(pos), std::ios_base::beg, which);
    }

  private:
    char *data_ = nullptr;
    size_t at_ = 0, size_ = 0, capacity_ = 0;
};

/* Writes the same bytes as Archive::write() for grids with different names and trees, but makes one grid at a time: the tree of a grid
 * takes several times the memory of the file, and all grids together more than the frame. */
struct memory_archive : openvdb::io::Archive {
    void to(std::ostream &os, size_t n_grids, const vdb::grid_maker &make,
            const openvdb::MetaMap &metadata) const
    {
        namespace io = openvdb::io;
        io::StreamMetadata::Ptr stream(new io::StreamMetadata);
        io::setStreamMetadataPtr(os, stream, /*transfer=*/false);
        io::setDataCompression(os, compression());
        io::setWriteGridStatsMetadata(os, isGridStatsMetadataEnabled());
        writeHeader(os, /*seekable=*/true);
        metadata.writeMeta(os);
        const int32_t count = int32_t(n_grids);
        os.write(reinterpret_cast<const char *>(&count), sizeof count);
        for (size_t i = 0; i < n_grids; i++) {
            const openvdb::GridBase::ConstPtr grid = make(i);
            io::GridDescriptor descriptor(grid->getName(), grid->type(), grid->saveFloatAsHalf());
            writeGrid(descriptor, grid, os, /*seekable=*/true);
            io::setDataCompression(os, compression()); /* writing a grid sets it to the grid's own */
        }
    }
};

/* A version 8 UUID (RFC 9562: vendor-specific): 58 bits of the identity, then the hash of all other bytes of the file. */
constexpr size_t UUID_AT = 21, UUID_SIZE = 36, HASH_AT = UUID_AT + 19;

void put_identity(char *bytes, uint64_t identity)
{
    char text[HASH_AT - UUID_AT + 1];
    std::snprintf(text, sizeof text, "%08x-%04x-8%03x-", static_cast<unsigned>(identity >> 32),
                  static_cast<unsigned>(identity >> 16 & 0xffff),
                  static_cast<unsigned>(identity >> 4 & 0xfff));
    std::memcpy(bytes + UUID_AT, text, sizeof text - 1);
}

/* The last digits of the UUID for this content. */
std::string hash_digits(const char *bytes, size_t size)
{
    const size_t rest = UUID_AT + UUID_SIZE;
    const uint64_t part[2] = {hash_bytes(bytes, HASH_AT), hash_bytes(bytes + rest, size - rest)};
    const uint64_t hash = hash_bytes(part, sizeof part);
    char text[rest - HASH_AT + 1];
    std::snprintf(text, sizeof text, "%04x-%04x%08x", static_cast<unsigned>(0x8000 | (hash >> 48 & 0x3fff)),
                  static_cast<unsigned>(hash >> 32 & 0xffff), static_cast<unsigned>(hash & 0xffffffff));
    return text;
}
} // namespace

namespace vdb
{
void start()
{
    static std::once_flag once;
    std::call_once(once, [] {
        openvdb::initialize();
        /* OpenVDB would log warnings to stdout, which farm managers parse. */
        openvdb::logging::setLevel(openvdb::logging::Level::Fatal);
    });
}

openvdb::MetaMap file_metadata(const vdb_options &options, double voxel)
{
    const bool y_up = options.up == OUTPUT_UP_Y;
    openvdb::MetaMap m;
    /* Blender rotates a y-up file upright only if its creator starts with "Houdini". */
    const std::string by =
        std::string(y_up ? "Houdini axes (y up); written by hoodoo " : "hoodoo ") + hoodoo_version;
    m.insertMeta("creator", openvdb::StringMetadata(by));
    m.insertMeta("up_axis", openvdb::StringMetadata(y_up ? "Y" : "Z"));
    m.insertMeta("meters_per_unit", openvdb::DoubleMetadata(1.0));
    m.insertMeta("voxel_size", openvdb::DoubleMetadata(voxel));
    m.insertMeta("frame", openvdb::Int32Metadata(options.frame));
    return m;
}

bool is_y_up(const openvdb::MetaMap &metadata)
{
    const auto up = metadata.getMetadata<openvdb::StringMetadata>("up_axis");
    if (up)
        return up->value() == "Y" || up->value() == "y";
    const auto creator = metadata.getMetadata<openvdb::StringMetadata>("creator");
    return creator && creator->value().compare(0, 7, "Houdini") == 0;
}

void encode(size_t n_grids, const grid_maker &make, const vdb_options &options,
            const openvdb::MetaMap &metadata, vdb_bytes *out)
{
    uint32_t flags = openvdb::io::COMPRESS_ACTIVE_MASK;
    if (options.codec == VDB_CODEC_BLOSC)
        flags |= openvdb::io::COMPRESS_BLOSC;
    else if (options.codec == VDB_CODEC_ZIP)
        flags |= openvdb::io::COMPRESS_ZIP;
    memory_archive archive;
    archive.setCompression(flags);
    memory_sink sink;
    std::ostream os(&sink);
    os.exceptions(std::ios::badbit | std::ios::failbit);
    archive.to(os, n_grids, make, metadata);
    if (sink.size() < UUID_AT + UUID_SIZE || sink.data()[UUID_AT + 8] != '-')
        throw std::runtime_error("OpenVDB's file header has an unknown layout");
    put_identity(sink.data(), options.identity);
    const std::string hash = hash_digits(sink.data(), sink.size());
    std::memcpy(sink.data() + HASH_AT, hash.data(), hash.size());
    out->size = sink.size();
    out->bytes = sink.release();
}

bool is_intact(const void *bytes, size_t size)
{
    /* The metadata of the file and of each grid contain the name, so one damaged byte cannot hide that hoodoo wrote the file. */
    const char *text = static_cast<const char *>(bytes);
    if (size < UUID_AT + UUID_SIZE)
        return false;
    if (!memmem(text, size < 4096 ? size : 4096, "hoodoo", 6))
        return true;
    const std::string hash = hash_digits(text, size);
    return std::memcmp(text + HASH_AT, hash.data(), hash.size()) == 0;
}
} // namespace vdb
