// The labels selected or drawn last, in the order of the user's actions. A label that is not stored
// yet already has its place.

export interface TrailEntry {
  /** Null until it is stored. */
  id: number | null;
}

const kKept = 50;

export class Trail {
  private places: TrailEntry[] = [];

  /** Adds a selected label. Null: a label that is not stored yet; the caller sets its id later. */
  add(id: number | null): TrailEntry {
    const last = this.places.at(-1);
    if (last && id !== null && last.id === id) return last;
    const place = { id };
    this.places = [...this.places, place].slice(-kKept);
    return place;
  }

  /** Removes the place of a label that was not created. */
  remove(place: TrailEntry): void {
    this.places = this.places.filter((other) => other !== place);
  }

  /** Returns the current places, the oldest first. */
  list(): readonly TrailEntry[] {
    return this.places;
  }
}
