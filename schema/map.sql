-- The tables of a map file (FORMAT.md 2). The library runs this very text to make one.

PRAGMA application_id = 1297108273;  -- 0x4D504D31, "MPM1"
PRAGMA user_version = 2;             -- of the format

-- build, feature, west_deg, south_deg, east_deg, north_deg
CREATE TABLE meta (
  key   TEXT PRIMARY KEY,
  value ANY NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE layers (
  name       TEXT PRIMARY KEY,
  parameters TEXT NOT NULL  -- a JSON object
) STRICT, WITHOUT ROWID;

CREATE TABLE segments (
  id       TEXT PRIMARY KEY,
  length_m REAL NOT NULL CHECK (length_m >= 0)
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
  successor TEXT NOT NULL,     -- a segment's id, of this map or of another
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

CREATE INDEX tiles_by_from ON tiles (segment, layer, from_m, to_m);

-- The longest tile of each layer of a segment. Tiles overlap; no tile that begins more than this
-- before a range reaches into it, so that a range is found by a short walk through tiles_by_from.
CREATE TABLE spans (
  segment   TEXT NOT NULL REFERENCES segments (id),
  layer     TEXT NOT NULL REFERENCES layers (name),
  longest_m REAL NOT NULL,  -- largest to_m - from_m
  PRIMARY KEY (segment, layer)
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
