-- The tables of the client's cache. The library runs this very text to make one.
-- Nothing in it is precious: what is missing or damaged is fetched again.

PRAGMA application_id = 1297108785;  -- 0x4D504F31, "MPO1"
PRAGMA user_version = 1;             -- of this layout

-- Tiles and cells as the server stores them, and the documents that tell which there are.
-- A cell has segment '' and its number in the grid. A document has layer '': a segment's has number
-- 0; the map's has segment '' and number 0; the index of the map's cells has segment '' and number 1.
CREATE TABLE entries (
  id         INTEGER PRIMARY KEY,
  map        TEXT NOT NULL,
  build      TEXT NOT NULL,
  segment    TEXT NOT NULL,
  layer      TEXT NOT NULL,
  number     INTEGER NOT NULL,   -- the tile's index, or the cell's number
  digest     TEXT NOT NULL,      -- of the content, checked whenever it is read
  bytes      INTEGER NOT NULL,   -- length of the content
  last_use_s INTEGER NOT NULL,   -- since 1970
  content    BLOB NOT NULL,
  UNIQUE (map, build, segment, layer, number)
) STRICT;

-- Oldest use first; a document outlives the tiles that were last used in the same second.
CREATE INDEX entries_by_use ON entries (last_use_s, layer = '', id);

-- The documents apart from the tiles, to find maps and segments when no server answers.
CREATE INDEX documents ON entries (map, last_use_s) WHERE layer = '';

-- The bytes of all entries, kept by the triggers, so that the limit is checked without counting.
CREATE TABLE total (bytes INTEGER NOT NULL) STRICT;
INSERT INTO total VALUES (0);

CREATE TRIGGER entry_added AFTER INSERT ON entries BEGIN
  UPDATE total SET bytes = bytes + new.bytes;
END;

CREATE TRIGGER entry_removed AFTER DELETE ON entries BEGIN
  UPDATE total SET bytes = bytes - old.bytes;
END;
