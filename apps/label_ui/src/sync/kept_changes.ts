// Changes that the server has not stored yet, as this browser keeps them: for each page and map one entry
// of its storage.

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

/** Of the page of that name, on the map of that version. */
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

/** No changes where that cannot be read. */
export function readKept({ key }: Entry): Kept {
  try {
    const kept = JSON.parse(localStorage.getItem(key) ?? '[]') as Change[] | Kept;
    if (Array.isArray(kept)) return { name: '', place: '', changes: kept };
    if (Array.isArray(kept.changes)) return kept;
  } catch {
    // As where there is nothing.
  }
  return { name: '', place: '', changes: [] };
}

/** Whether it is kept: the browser may have no room. */
export function writeKept({ key }: Entry, kept: Kept): boolean {
  try {
    if (kept.changes.length === 0) localStorage.removeItem(key);
    else localStorage.setItem(key, JSON.stringify(kept));
    return true;
  } catch {
    return false;
  }
}
