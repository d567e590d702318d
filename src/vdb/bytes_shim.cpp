/* OpenVDB archives as drafts. File::write() does not notice a full disk and puts random bytes into each archive. Here the archive goes to
 * a draft, and its UUID is made from the file's identity and a hash of its content. */
#include "vdb/shim.hpp"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/util/logging.h>

#include <cstdio>
#include <cstring>
#include <mutex>
#include <ostream>
#include <streambuf>

extern "C" {
#include "base/hash.h"
}

namespace
{
/* A version 8 UUID (RFC 9562: vendor-specific): 58 bits of the identity, then the hash of all other bytes of the file. */
constexpr size_t UUID_AT = 21, UUID_SIZE = 36, HASH_AT = UUID_AT + 19;

/* A stream into a draft that can seek back, as the archive does to fill in grid offsets. */
class draft_sink : public std::streambuf
{
  public:
    explicit draft_sink(draft &to) : to_(to)
    {
    }
    /* The first failure; the stream only knows that there was one. */
    status failure() const
    {
        return failure_;
    }

  protected:
    std::streamsize xsputn(const char *bytes, std::streamsize n) override
    {
        const uint64_t end = at_ + static_cast<uint64_t>(n), old = at_ < to_.size ? to_.size - at_ : 0;
        const size_t inside = static_cast<size_t>(end > to_.size ? old : static_cast<uint64_t>(n));
        if (failure_ == OK && at_ > to_.size)
            failure_ = fail(E_OUTPUT, "OpenVDB skipped bytes of a file");
        if (failure_ == OK && inside)
            failure_ = draft_replace(&to_, at_, bytes, inside);
        if (failure_ == OK)
            failure_ = draft_append(&to_, bytes + inside, static_cast<size_t>(n) - inside);
        at_ = end;
        return failure_ == OK ? n : 0;
    }
    int_type overflow(int_type c) override
    {
        const char byte = traits_type::to_char_type(c);
        return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
    }
    pos_type seekoff(off_type off, std::ios_base::seekdir way, std::ios_base::openmode) override
    {
        const off_type base = way == std::ios_base::beg   ? 0
                              : way == std::ios_base::cur ? static_cast<off_type>(at_)
                                                          : static_cast<off_type>(to_.size);
        if (base + off < 0)
            return pos_type(off_type(-1));
        at_ = static_cast<uint64_t>(base + off);
        return pos_type(base + off);
    }
    pos_type seekpos(pos_type pos, std::ios_base::openmode which) override
    {
        return seekoff(off_type(pos), std::ios_base::beg, which);
    }

  private:
    draft &to_;
    uint64_t at_ = 0;
    status failure_ = OK;
};

/* Writes the same bytes as Archive::write() for grids with different names and trees, but makes one grid at a time: the tree of a grid
 * takes several times the memory of the file, and all grids together more than the frame. */
struct grid_archive : openvdb::io::Archive {
    void to(std::ostream &os, size_t n_grids, const vdb::grid_maker &make,
            const openvdb::MetaMap &metadata) const
    {
        namespace io = openvdb::io;
        io::StreamMetadata::Ptr stream(new io::StreamMetadata);
        io::setStreamMetadataPtr(os, stream, /*transfer=*/false);
        io::setDataCompression(os, compression());
        io::setWriteGridStatsMetadata(os, isGridStatsMetadataEnabled());
        writeHeader(os, /*seekable=*/true);
        if (os.tellp() != std::streamoff(UUID_AT + UUID_SIZE))
            throw std::runtime_error("OpenVDB's file header has an unknown layout");
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

std::string identity_digits(uint64_t identity)
{
    char text[HASH_AT - UUID_AT + 1];
    std::snprintf(text, sizeof text, "%08x-%04x-8%03x-", static_cast<unsigned>(identity >> 32),
                  static_cast<unsigned>(identity >> 16 & 0xffff),
                  static_cast<unsigned>(identity >> 4 & 0xfff));
    return text;
}

/* The last digits of the UUID, given the hashes of what comes before and after them. */
std::string hash_digits(const uint64_t part[2])
{
    const uint64_t hash = hash_bytes(part, 2 * sizeof *part);
    char text[UUID_AT + UUID_SIZE - HASH_AT + 1];
    std::snprintf(text, sizeof text, "%04x-%04x%08x", static_cast<unsigned>(0x8000 | (hash >> 48 & 0x3fff)),
                  static_cast<unsigned>(hash >> 32 & 0xffff), static_cast<unsigned>(hash & 0xffffffff));
    return text;
}

void check(status st)
{
    if (st != OK)
        throw vdb::refused{st};
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
            const openvdb::MetaMap &metadata, draft *out)
{
    uint32_t flags = openvdb::io::COMPRESS_ACTIVE_MASK;
    if (options.codec == VDB_CODEC_BLOSC)
        flags |= openvdb::io::COMPRESS_BLOSC;
    else if (options.codec == VDB_CODEC_ZIP)
        flags |= openvdb::io::COMPRESS_ZIP;
    grid_archive archive;
    archive.setCompression(flags);
    draft_sink sink(*out);
    std::ostream os(&sink);
    os.exceptions(std::ios::badbit | std::ios::failbit);
    try {
        archive.to(os, n_grids, make, metadata);
    } catch (const std::ios_base::failure &) {
        check(sink.failure());
        throw;
    }
    check(sink.failure()); /* OpenVDB may have ignored it */
    const std::string identity = identity_digits(options.identity);
    check(draft_replace(out, UUID_AT, identity.data(), identity.size()));
    uint64_t part[2];
    check(draft_hash(out, 0, HASH_AT, &part[0]));
    check(draft_hash(out, UUID_AT + UUID_SIZE, out->size, &part[1]));
    const std::string hash = hash_digits(part);
    check(draft_replace(out, HASH_AT, hash.data(), hash.size()));
}

bool is_intact(const void *bytes, size_t size)
{
    /* The metadata of the file and of each grid contain the name, so one damaged byte cannot hide that hoodoo wrote the file. */
    const char *text = static_cast<const char *>(bytes);
    if (size < UUID_AT + UUID_SIZE)
        return false;
    if (!memmem(text, size < 4096 ? size : 4096, "hoodoo", 6))
        return true;
    const size_t rest = UUID_AT + UUID_SIZE;
    const uint64_t part[2] = {hash_bytes(text, HASH_AT), hash_bytes(text + rest, size - rest)};
    const std::string hash = hash_digits(part);
    return std::memcmp(text + HASH_AT, hash.data(), hash.size()) == 0;
}
} // namespace vdb
