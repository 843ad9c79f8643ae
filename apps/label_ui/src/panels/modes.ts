// The mode of the page: the ground or the people in images, and whether a click draws.
import type { Drawing } from '../ground/drawing';
import { byId, hint } from './messages';
import type { PeopleWork } from '../people/people_work';
import type { Store } from '../store';

const kNoPicture = 'This map has no overhead image: only people can be labelled. `roadbook overhead` makes the image';

export class Modes {
  constructor(
    private readonly store: Store,
    private readonly people: PeopleWork,
    private readonly drawing: Drawing,
  ) {
    byId('mode-ground').addEventListener('click', () => this.toPeople(false));
    byId('mode-people').addEventListener('click', () => this.toPeople(true));
    store.on('class', () => drawing.active && drawing.start());
    if (store.start.picture) return;
    byId('mode-ground').setAttribute('aria-disabled', 'true');
    byId('mode-ground').title = kNoPicture;
  }

  toPeople(on: boolean): void {
    if (!on && !this.store.start.picture) return hint(kNoPicture, true);
    if (this.drawing.active) this.toggleDrawing();
    document.body.classList.toggle('people', on);
    for (const [id, chosen] of [['mode-ground', !on], ['mode-people', on]] as const)
      byId(id).setAttribute('aria-pressed', String(chosen));
    this.people.activate(on);
    byId(on ? 'people-picture' : 'map').focus();
  }

  toggle(): void {
    this.toPeople(!this.people.active);
  }

  toggleDrawing(): void {
    const { drawing } = this;
    if (drawing.active) drawing.stop();
    else drawing.start();
    byId('draw').setAttribute('aria-pressed', String(drawing.active));
    byId('map').classList.toggle('drawing', drawing.active);
  }
}
