// The questions about people in an image, including the user's skips and moves. Only the page
// stores these skips and moves, and only the page can undo them.
import { Nudges } from '../sync/nudges';
import type { PageStep } from '../sync/steps';
import { imageName, sameImage, type ImageName, type PeopleImage, type PersonHypothesis, type Upright } from '../types';

interface Page {
  image: PeopleImage | null;
  overview: { round: number };
  /**
   * Shows an image and the hypothesis of that name as a question, or the least certain hypothesis.
   */
  showStep(image: ImageName, name: string): Promise<void>;
  notify(): void;
}

export class AskedPeople {
  private readonly skipped = new Set<string>();
  private readonly nudges: Nudges<Upright>;
  /** The images of the hypotheses that keys have moved. */
  private readonly images = new Map<string, ImageName>();

  constructor(
    private readonly page: Page,
    private readonly addStep: (step: PageStep) => void,
  ) {
    this.nudges = new Nudges<Upright>(({ name, before, now }) => {
      const to = (shape: Upright) => (): Promise<void> => {
        this.nudges.set(name, shape);
        return page.showStep(this.images.get(name)!, name);
      };
      this.step('Move', this.images.get(name)!, to(before), to(now));
    });
  }

  /** Returns the open hypotheses in the displayed image, the least certain first. */
  open(): PersonHypothesis[] {
    const doubt = (h: PersonHypothesis): number => Math.abs(h.probability - 0.5);
    const all = (this.page.image?.hypotheses ?? []).map((h) => ({ ...h, ...this.nudges.of(this.nameOf(h)) }));
    return all.sort((a, b) => doubt(a) - doubt(b));
  }

  /** Returns a name that stays the same when keys change the shape. */
  nameOf({ index }: PersonHypothesis): string {
    const found = this.page.image!.hypotheses.find((h) => h.index === index)!;
    return `${imageName(this.page.image!)} ${found.foot} ${found.head}`;
  }

  isSkipped(h: PersonHypothesis): boolean {
    return this.skipped.has(this.nameOf(h));
  }

  skip(h: PersonHypothesis): void {
    this.flush();
    const [image, name] = [this.page.image!, this.nameOf(h)];
    const skip = (on: boolean): void => void (on ? this.skipped.add(name) : this.skipped.delete(name));
    const to = (on: boolean) => (): Promise<void> => {
      skip(on);
      return this.page.showStep(image, on ? '' : name);
    };
    skip(true);
    this.step('Skip', image, to(false), to(true));
  }

  /** Keys have changed the shape of a hypothesis. */
  reshape(h: PersonHypothesis, { foot, head, outline }: Upright): void {
    const name = this.nameOf(h);
    this.images.set(name, this.page.image!);
    this.nudges.change(name, { foot: h.foot, head: h.head, outline: h.outline }, { foot, head, outline });
    this.page.notify();
  }

  flush(): void {
    this.nudges.flush();
  }

  private step(name: string, image: ImageName, undo: () => Promise<void>, redo: () => Promise<void>): void {
    const { page } = this;
    const { round } = page.overview;
    // The hypotheses of another round differ. The step stays valid only for the image that is still
    // displayed unchanged.
    const isValid = (): boolean => page.overview.round === round || (page.image !== null && sameImage(page.image, image));
    this.addStep({ type: 'own', name, isValid, undo, redo });
  }
}
