#include "slam_glue/mrpt_grid.hpp"

#include <fmt/format.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>
#include <optional>

#include "slam_glue/gzip.hpp"
#include "slam_glue/map_files.hpp"
#include "world/error.hpp"

namespace outrider::slam_glue {

/// Opens the protected placement; the run-time class, and so the archive, stays COccupancyGridMap2D.
struct MrptGrid::Impl : mrpt::maps::COccupancyGridMap2D {
  explicit Impl(const GridGeometry& g) {
    const auto res = static_cast<float>(g.resolution);
    setSize(0.0F, static_cast<float>(g.width) * res, 0.0F, static_cast<float>(g.height) * res, res);
    m_size_x = static_cast<std::uint32_t>(g.width);
    m_size_y = static_cast<std::uint32_t>(g.height);
    m_map.assign(g.size(), 0);
    m_xMin = static_cast<float>(g.origin.x);
    m_yMin = static_cast<float>(g.origin.y);
    m_xMax = static_cast<float>(g.origin.x + g.width * g.resolution);
    m_yMax = static_cast<float>(g.origin.y + g.height * g.resolution);
    m_is_empty = false;
  }
};

MrptGrid::MrptGrid(const GridGeometry& geometry) : impl_(std::make_unique<Impl>(geometry)) {}
MrptGrid::~MrptGrid() = default;
MrptGrid::MrptGrid(MrptGrid&&) noexcept = default;
MrptGrid& MrptGrid::operator=(MrptGrid&&) noexcept = default;

std::int8_t* MrptGrid::cells() { return impl_->getRow(0); }

namespace {

template <class Stream>
void write_archive(const mrpt::maps::COccupancyGridMap2D& grid, const std::filesystem::path& file) {
  try {
    Stream stream;
    if (!stream.open(file.string())) throw std::runtime_error("cannot open");
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive << grid;
  } catch (const std::exception&) {  // MRPT's texts are back-traces of many lines
    throw std::runtime_error(fmt::format("{}: cannot write the grid map", file.string()));
  }
}

}  // namespace

void MrptGrid::save(const std::filesystem::path& gridmap) const {
  const bool gz = gridmap.extension() == ".gz";
  if (gz)
    write_archive<mrpt::io::CFileGZOutputStream>(*impl_, gridmap);
  else
    write_archive<mrpt::io::CFileOutputStream>(*impl_, gridmap);
  // MRPT's streams swallow errors on closing (a full disk): see whether the bytes arrived.
  const std::optional<std::uint64_t> bytes = gzip_plain_size(gridmap);
  if (!bytes || *bytes < impl_->getRawMap().size())
    throw std::runtime_error(fmt::format("{}: could not be written completely", gridmap.string()));
}

OccupancyGrid load_gridmap(const std::filesystem::path& file) {
  if (!gzip_plain_size(file)) throw InputError(fmt::format("{}: damaged or truncated gzip file", file.string()));
  mrpt::maps::COccupancyGridMap2D grid;
  try {
    mrpt::io::CFileGZInputStream stream(file.string());
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive >> grid;
  } catch (const std::exception&) {
    throw InputError(fmt::format("{}: not a complete MRPT occupancy grid map", file.string()));
  }
  GridGeometry g{std::round(static_cast<double>(grid.getResolution()) * 1e6) * 1e-6,
                 {static_cast<double>(grid.getXMin()), static_cast<double>(grid.getYMin())},
                 static_cast<int>(grid.getSizeX()),
                 static_cast<int>(grid.getSizeY())};
  if (!(g.resolution > 0.0) || g.width <= 0 || g.height <= 0 || grid.getRawMap().size() != g.size())
    throw InputError(fmt::format("{}: the grid map is empty", file.string()));
  OccupancyGrid map(g);
  const auto& cells = grid.getRawMap();
  for (std::size_t i = 0; i < cells.size(); ++i)
    map[i] = cells[i] > 0 ? CellState::kFree : cells[i] < 0 ? CellState::kOccupied : CellState::kUnknown;
  return map;
}

void save_gridmap(const OccupancyGrid& map, const std::filesystem::path& file) {
  MrptGrid grid(map.geometry());
  constexpr std::int8_t kCertain = 80;  // P = 0.993
  std::int8_t* cells = grid.cells();
  for (std::size_t i = 0; i < map.size(); ++i)
    cells[i] = map[i] == CellState::kFree       ? kCertain
               : map[i] == CellState::kOccupied ? std::int8_t{-kCertain}
                                                : std::int8_t{0};
  grid.save(file);
}

}  // namespace outrider::slam_glue
