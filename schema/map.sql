-- The tables of a map file (FORMAT.md 2). The library runs this very text to make one.

PRAGMA application_id = 1297108273;  -- 0x4D504D31, "MPM1"
PRAGMA user_version = 3;             -- of the format

-- build, manifest, feature, west_deg, south_deg, east_deg, north_deg; datum and mapping if there are
CREATE TABLE meta (
  key   TEXT PRIMARY KEY,
  value ANY NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE layers (
  name       TEXT PRIMARY KEY,
  parameters TEXT NOT NULL  -- a JSON object
) STRICT, WITHOUT ROWID;

CREATE TABLE segments (
  id                     TEXT PRIMARY KEY,
  length_m               REAL NOT NULL CHECK (length_m >= 0),
  position_sigma_m       REAL,             -- of the map's own position error; NULL: unknown
  position_correlation_m REAL,             -- likewise
  assumed                INTEGER NOT NULL  -- 1: these two are assumed, not measured
) STRICT, WITHOUT ROWID;

CREATE TABLE vertices (
  segment       TEXT NOT NULL REFERENCES segments (id),
  position      INTEGER NOT NULL,  -- 0, 1, 2, ... along the line
  latitude_deg  REAL NOT NULL,
  longitude_deg REAL NOT NULL,
  altitude_m    REAL NOT NULL,
  along_m       REAL NOT NULL,
  PRIMARY KEY (segment, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE successors (
  segment   TEXT NOT NULL REFERENCES segments (id),
  position  INTEGER NOT NULL,  -- 0, 1, 2, ...
  map       TEXT NOT NULL,     -- the neighbour map's name; '': this map
  successor TEXT NOT NULL,     -- a segment's id in that map
  PRIMARY KEY (segment, position)
) STRICT, WITHOUT ROWID;

-- The drives that passed a segment.
CREATE TABLE passes (
  segment  TEXT NOT NULL REFERENCES segments (id),
  position INTEGER NOT NULL,  -- 0, 1, 2, ...
  drive    TEXT NOT NULL,     -- its name
  from_m   REAL NOT NULL,     -- arc length along the drive where the segment begins
  to_m     REAL NOT NULL,     -- ... and where it ends
  PRIMARY KEY (segment, position)
) STRICT, WITHOUT ROWID;

-- The bytes of the tiles, apart from their index: a look through the index reads none of them.
CREATE TABLE frames (
  id    INTEGER PRIMARY KEY,
  frame BLOB NOT NULL
) STRICT;

-- The tile index.
CREATE TABLE tiles (
  segment TEXT NOT NULL REFERENCES segments (id),
  layer   TEXT NOT NULL REFERENCES layers (name),
  number  INTEGER NOT NULL CHECK (number BETWEEN 0 AND 4294967295),  -- the tile's index
  from_m  REAL NOT NULL,  -- [from_m, to_m] holds the along range of every item
  to_m    REAL NOT NULL CHECK (to_m >= from_m),
  items   INTEGER NOT NULL CHECK (items >= 0),
  bytes   INTEGER NOT NULL CHECK (bytes >= 0),  -- length of the frame
  digest  TEXT NOT NULL,                        -- of the frame
  frame   INTEGER NOT NULL UNIQUE REFERENCES frames (id),
  PRIMARY KEY (segment, layer, number)
) STRICT, WITHOUT ROWID;

-- The index of the cells: tiles of an area, by the grid of FORMAT.md 6.1.
CREATE TABLE cells (
  layer  TEXT NOT NULL REFERENCES layers (name),
  number INTEGER NOT NULL CHECK (number BETWEEN 0 AND 2591999999),  -- the cell's
  items  INTEGER NOT NULL CHECK (items >= 0),
  bytes  INTEGER NOT NULL CHECK (bytes >= 0),  -- length of the frame
  digest TEXT NOT NULL,                        -- of the frame
  frame  INTEGER NOT NULL UNIQUE REFERENCES frames (id),
  PRIMARY KEY (layer, number)
) STRICT, WITHOUT ROWID;
