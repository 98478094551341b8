-- The tables of the client's cache. The library runs this very text to make one.
-- Nothing in it is precious: what is missing or damaged is fetched again. A file of another layout
-- is set aside as a damaged one is, and a new one is begun.

PRAGMA application_id = 1297108785;  -- 0x4D504F31, "MPO1"
PRAGMA user_version = 4;             -- of this layout; 3 found nothing by its digest

-- Tiles and cells as the server stores them, and the documents that tell which there are.
-- A cell has segment '' and its number in the grid. A document has layer '': a segment's has number
-- 0; the map's has segment '' and number 0; the index of the map's cells has segment '' and number
-- 1; the manifest has segment '' and number 2, its signature segment '' and number 3. Of a tile or a document the reader knows the digest:
-- the build for the manifest, which lists those of the documents, which list those of the tiles.
CREATE TABLE entries (
  id       INTEGER PRIMARY KEY,
  map      TEXT NOT NULL,
  build    TEXT NOT NULL,
  segment  TEXT NOT NULL,
  layer    TEXT NOT NULL,
  number   INTEGER NOT NULL,   -- the tile's index, or the cell's number
  digest   TEXT NOT NULL,      -- of the content, to find it and its damage; not relied upon
  bytes    INTEGER NOT NULL,   -- length of the content
  last_use INTEGER NOT NULL,   -- uses are numbered: each gets one more than the greatest here
  content  BLOB NOT NULL,
  UNIQUE (map, build, segment, layer, number)
) STRICT;

-- What a new build has in common with the one before it, so that it is not fetched again.
CREATE INDEX entries_by_digest ON entries (digest);

-- The greatest number of a use. No clock is asked: a vehicle's may be wrong by decades.
CREATE INDEX entries_by_use ON entries (last_use);

-- What goes first: the least recently used entry, where a document counts as used 1000 uses later.
-- So it outlives the tiles that it leads to, whose uses follow its own.
CREATE INDEX entries_by_eviction ON entries (last_use + 1000 * (layer = ''));

-- The sizes, to count the bytes of all entries without reading these.
CREATE INDEX entries_by_size ON entries (bytes);

-- The documents apart from the tiles, to find maps and segments when no server answers.
CREATE INDEX documents ON entries (map, last_use) WHERE layer = '';

-- The bytes of all entries, kept by the triggers, so that the limit is checked without counting.
-- Counted anew when the file is opened, after every 64 entries removed, and when it is no number
-- that can be.
CREATE TABLE total (bytes INTEGER NOT NULL) STRICT;
INSERT INTO total VALUES (0);

CREATE TRIGGER entry_added AFTER INSERT ON entries BEGIN
  UPDATE total SET bytes = bytes + new.bytes;
END;

CREATE TRIGGER entry_removed AFTER DELETE ON entries BEGIN
  UPDATE total SET bytes = bytes - old.bytes;
END;
