import { ask } from './api';
import type { Stage } from './stage';
import type { Stream } from './stream';
import { element } from './element';

interface Status {
  frames: { accepted: number; refused: number; lost: number; overrun: number };
  queue: { overloaded: boolean };
  update_us: { median: number; p99: number };
  hypotheses: number;
}

const EVERY = 2000; // ms

/** The line at the bottom: how the daemon is, and how this page is. */
export class StatusLine {
  private readonly line = element('status');
  private accepted = NaN;
  private last = { time: performance.now(), bytes: 0, drawn: 0 };

  constructor(private readonly stage: Stage) {}

  watch(stream: Stream): void {
    setInterval(() => void this.tell(stream), EVERY);
    void this.tell(stream);
  }

  lost(why: string): void {
    this.line.textContent = `no connection: ${why}; trying again`;
    this.line.className = 'lost';
  }

  private async tell(stream: Stream): Promise<void> {
    let status: Status;
    try {
      status = await ask<Status>('/v1/status');
    } catch (error) {
      return this.lost((error as Error).message);
    }
    const now = { time: performance.now(), bytes: stream.bytes, drawn: this.stage.frames };
    const seconds = (now.time - this.last.time) / 1000;
    const rate = (status.frames.accepted - this.accepted) / seconds;
    const { refused, lost, overrun } = status.frames;
    this.line.textContent = [
      `${Number.isFinite(rate) ? rate.toFixed(0) : '-'} frames/s`,
      `update ${(status.update_us.median / 1000).toFixed(1)} ms, 99 %: ${(status.update_us.p99 / 1000).toFixed(1)} ms`,
      `refused ${refused}, lost ${lost}, overrun ${overrun}`,
      `${status.hypotheses} hypotheses`,
      `stream ${((now.bytes - this.last.bytes) / 1000 / seconds).toFixed(1)} kB/s`,
      `${((now.drawn - this.last.drawn) / seconds).toFixed(0)} pictures/s`,
    ].join(' · ') + (status.queue.overloaded ? ' · OVERLOADED' : '');
    this.line.className = '';
    this.accepted = status.frames.accepted;
    this.last = now;
  }
}
