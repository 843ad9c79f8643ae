// Shows a camera image with its windows: the labels and the people that the detector found.
import { useCross } from './people_keys';
import { kPerson } from './people_drafts';
import type { Chosen, PeopleWork } from './people_work';
import type { Store } from '../store';
import { imageName, isRejected, type Point, type Upright } from '../types';

const kSvg = 'http://www.w3.org/2000/svg';

interface Drawn {
  shape: Upright;
  look: string;
  chosen: Chosen;
  name: string;
}

function element(name: string, fields: Record<string, string | number>): SVGElement {
  const made = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(fields)) made.setAttribute(key, String(value));
  return made;
}

const pointsOf = (outline: Point[]): string =>
  outline.map(([u, v]) => `${u.toFixed(1)},${v.toFixed(1)}`).join(' ');

export class PeoplePicture {
  private readonly svg = element('svg', { role: 'img' }) as SVGSVGElement;
  private readonly photo = element('image', {}) as SVGImageElement;
  private readonly over = element('g', {});
  private shown = '';
  private scale = 1;
  private middle: Point = [0, 0];
  private cross: Point = [0, 0];
  private pointer: Point | null = null;

  constructor(
    private readonly box: HTMLElement,
    private readonly store: Store,
    private readonly people: PeopleWork,
  ) {
    this.svg.append(this.photo, this.over);
    box.append(this.svg);
    people.on(() => this.show());
    this.svg.addEventListener('click', (event) => this.click(event));
    this.svg.addEventListener('pointermove', (event) => this.move(event));
    this.svg.addEventListener('wheel', (event) => this.wheel(event));
    useCross({
      at: () => this.cross,
      move: (dx, dy) => this.moveCross(dx, dy),
      zoom: (factor) => this.zoom(factor, this.focus()),
      whole: () => this.whole(),
    });
  }

  /** Returns the image pixel under the pointer. */
  private at(event: MouseEvent): Point {
    const p = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.svg.getScreenCTM()!.inverse());
    return [p.x, p.y];
  }

  private click(event: MouseEvent): void {
    const p = this.at(event);
    this.box.focus();
    if (this.people.points) return this.people.point(p);
    const hit = (event.target as Element).closest<SVGElement>('.hit');
    const chosen = hit && this.all()[Number(hit.dataset.place)]?.chosen;
    this.people.choose(chosen || { type: 'none' });
  }

  private move(event: MouseEvent): void {
    if (!this.people.points) return;
    this.pointer = this.cross = this.at(event);
    this.show();
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    this.zoom(event.deltaY < 0 ? 1.2 : 1 / 1.2, this.at(event));
  }

  // Returns the point that stays in place when the user zooms.
  private focus(): Point {
    const one = this.people.hypothesis() ?? (this.people.window() as Upright | null);
    if (one) return [(one.foot[0] + one.head[0]) / 2, (one.foot[1] + one.head[1]) / 2];
    return this.people.points ? this.cross : this.middle;
  }

  private zoom(factor: number, around: Point): void {
    const scale = Math.min(8, Math.max(1, this.scale * factor));
    const part = this.scale / scale;
    this.middle = [around[0] + (this.middle[0] - around[0]) * part, around[1] + (this.middle[1] - around[1]) * part];
    this.scale = scale;
    this.frame();
    this.show();
  }

  private whole(): void {
    const { image } = this.people;
    this.scale = 1;
    if (image) this.middle = [image.width / 2, image.height / 2];
    this.frame();
    this.show();
  }

  private moveCross(dx: number, dy: number): void {
    const { image, points } = this.people;
    if (!image) return;
    if (!points) {
      this.middle = [this.middle[0] + dx, this.middle[1] + dy];
      return this.frame();
    }
    const clamp = (v: number, most: number): number => Math.min(most - 1, Math.max(0, v));
    this.cross = [clamp(this.cross[0] + dx, image.width), clamp(this.cross[1] + dy, image.height)];
    this.pointer = this.cross;
    this.show();
  }

  private frame(): void {
    const { image } = this.people;
    if (!image) return;
    const [w, h] = [image.width / this.scale, image.height / this.scale];
    const clamp = (v: number, half: number, most: number): number => Math.min(most - half, Math.max(half, v));
    this.middle = [clamp(this.middle[0], w / 2, image.width), clamp(this.middle[1], h / 2, image.height)];
    this.svg.setAttribute('viewBox', `${this.middle[0] - w / 2} ${this.middle[1] - h / 2} ${w} ${h}`);
  }

  private all(): Drawn[] {
    const labels = this.people.windows().map((label) => ({
      shape: label as Upright,
      look: isRejected(label) ? 'nobody' : kPerson,
      chosen: { type: 'window', id: label.id } as Chosen,
      name: isRejected(label) ? `no person ${label.id}` : `person ${label.id}`,
    }));
    const open = this.people.asked.open().map((h) => ({
      shape: h as Upright,
      look: h.probability >= 0.5 && !this.people.asked.isSkipped(h) ? 'likely' : 'unlikely',
      chosen: { type: 'hypothesis', index: h.index } as Chosen,
      name: `person? ${Math.round(100 * h.probability)} %`,
    }));
    return [...labels, ...open];
  }

  private isChosen(drawn: Drawn): boolean {
    return JSON.stringify(drawn.chosen) === JSON.stringify(this.people.chosen);
  }

  private show(): void {
    const { image, points } = this.people;
    this.box.classList.toggle('drawing', points !== null);
    if (!image) return this.over.replaceChildren();
    const url = `api/image/${imageName(image)}?map=${encodeURIComponent(this.store.start.map)}`;
    if (url !== this.shown) {
      this.shown = url;
      // Publishes the name of the image for tools that control the page.
      this.box.dataset.image = imageName(image);
      for (const [key, value] of Object.entries({ href: url, width: image.width, height: image.height }))
        this.photo.setAttribute(key, String(value));
      this.cross = [image.width / 2, image.height / 2];
      this.whole();
    }
    const all = this.all();
    const names = all.map((drawn) => drawn.name).join(', ') || 'no person marked';
    this.svg.setAttribute('aria-label', `${image.place}: ${names}`);
    // Draws small windows above large ones, so that a click can select either of two overlapping
    // people.
    const order = all.map((_, i) => i).sort((a, b) => height(all[b].shape) - height(all[a].shape));
    const parts: SVGElement[] = [];
    for (const i of order) {
      const drawn = all[i];
      const outline = pointsOf(drawn.shape.outline);
      const marked = this.isChosen(drawn) ? ' marked' : '';
      parts.push(element('polygon', { points: outline, class: `casing${marked}` }));
      parts.push(element('polygon', { points: outline, class: drawn.look }));
      parts.push(element('polygon', { points: outline, class: 'hit', 'data-place': i }));
    }
    if (points) parts.push(...this.sketch(points));
    this.over.replaceChildren(...parts);
  }

  private sketch(points: Point[]): SVGElement[] {
    const [u, v] = this.cross;
    const arm = 9 / this.scale;
    const line = (a: Point, b: Point): SVGElement =>
      element('line', { x1: a[0], y1: a[1], x2: b[0], y2: b[1], class: 'sketch' });
    const parts = [line([u - arm, v], [u + arm, v]), line([u, v - arm], [u, v + arm])];
    if (points.length === 1) parts.push(line(points[0], this.pointer ?? this.cross));
    return parts;
  }
}

function height(shape: Upright): number {
  return Math.hypot(shape.foot[0] - shape.head[0], shape.foot[1] - shape.head[1]);
}
