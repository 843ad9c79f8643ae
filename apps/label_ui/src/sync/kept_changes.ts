// The changes that the server has not stored yet. The browser's storage has one entry for each page
// and map.

export interface Change {
  request: string;
  method: 'POST' | 'PUT' | 'DELETE';
  path: string;
  body: Record<string, unknown>;
  /** Fields that replace the body's fields if the map has been rebuilt (anchored.ts). */
  later?: Record<string, unknown>;
}

/**
 * `name` is the name of the map of these changes. `place` is its place, which stays the same if the
 * map is rebuilt (Start).
 */
export interface Kept {
  name: string;
  place: string;
  changes: Change[];
}

/** The entry of the page `page` on the map version `map`. */
export interface Entry {
  key: string;
  map: string;
  page: string;
}

const kBegin = 'roadbook_';

export const entryOf = (map: string, page: string): Entry => ({ key: `${kBegin}${map}/${page}`, map, page });

export function entries(): Entry[] {
  const keys = Object.keys(localStorage).filter((key) => key.startsWith(kBegin) && key.includes('/'));
  return keys.map((key) => {
    const [map, page] = [key.slice(kBegin.length, key.indexOf('/')), key.slice(key.indexOf('/') + 1)];
    return { key, map, page };
  });
}

/** Returns no changes if the entry is not readable. */
export function readKept({ key }: Entry): Kept {
  try {
    const kept = JSON.parse(localStorage.getItem(key) ?? '[]') as Change[] | Kept;
    if (Array.isArray(kept)) return { name: '', place: '', changes: kept };
    if (Array.isArray(kept.changes)) return kept;
  } catch {
    // The entry counts as empty.
  }
  return { name: '', place: '', changes: [] };
}

/** Returns whether the entry was written. The browser may have no room. */
export function writeKept({ key }: Entry, kept: Kept): boolean {
  try {
    if (kept.changes.length === 0) localStorage.removeItem(key);
    else localStorage.setItem(key, JSON.stringify(kept));
    return true;
  } catch {
    return false;
  }
}
